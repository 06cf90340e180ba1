#pragma once
/// What an ESVO file says of its octree beside the octree: the JSON of its META chunk.
#include <string>
#include <string_view>

#include "voxdag/file/vdag_metadata.hpp"
#include "voxdag/layout/esvo_counts.hpp"

namespace voxdag {

/// All of it depends on the input alone; see VdagMetadata.
struct EsvoMetadata {
  Grid grid;
  std::uint64_t root = 0;  ///< Slot of the root's descriptor in ESVO.
  EsvoCounts counts;
  VdagSource source;
  std::string program;
  std::map<std::string, std::string> build;
  friend bool operator==(const EsvoMetadata&, const EsvoMetadata&) = default;
};

std::string esvo_metadata_json(const EsvoMetadata& metadata);

/// Throws Error("", place, reason) as parse_vdag_metadata does.
EsvoMetadata parse_esvo_metadata(std::string_view json);

}  // namespace voxdag
