#pragma once
/// Reports the counts and sizes of an ESVO as tables and as JSON, for `build` and `info`.
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "voxdag/file/esvo_parse.hpp"
#include "voxdag/stored/esvo/esvo_bytes.hpp"

namespace voxdag {

struct EsvoReport {
  EsvoMetadata metadata;
  EsvoBytes bytes;
  std::uint64_t file_bytes = 0;

  double bytes_per_voxel() const {
    const std::uint64_t voxels = metadata.counts.voxels();
    return voxels == 0 ? 0 : static_cast<double>(bytes.total()) / static_cast<double>(voxels);
  }
};

/// Returns the report of an octree that was parsed from a file of `file_bytes` bytes.
EsvoReport report_of(const EsvoContents& contents, std::uint64_t file_bytes);

/// Returns the keys of `info --json`; docs/json.md lists them.
nlohmann::ordered_json esvo_json(const EsvoReport& report);

/// Returns a table of grid and placement, counts, and bytes by purpose.
std::string esvo_table(const EsvoReport& report);

/// Returns a table of the voxels and leaves of each level.
std::string esvo_level_table(const EsvoReport& report);

}  // namespace voxdag
