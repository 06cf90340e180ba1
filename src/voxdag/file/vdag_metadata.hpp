#pragma once
/// What a .vdag file says about its DAG beside the DAG: the JSON of its META chunk.
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "voxdag/core/grid.hpp"
#include "voxdag/layout/svdag_counts.hpp"

namespace voxdag {

/// The mesh that the voxels come from.
struct VdagSource {
  std::string name;  ///< File name without folders; UTF-8.
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
  friend bool operator==(const VdagSource&, const VdagSource&) = default;
};

/// All of it depends on the input alone, so that equal inputs make equal files: nothing here may
/// tell times, folders, thread counts or which of two equivalent methods ran.
struct VdagMetadata {
  Grid grid;
  SvdagCounts counts;
  VdagSource source;
  std::string program;  ///< "voxdag 0.1.0": who wrote the file.
  std::map<std::string, std::string>
      build;  ///< Settings that shape the result, e.g. "cover": "exact".
  friend bool operator==(const VdagMetadata&, const VdagMetadata&) = default;
};

/// The JSON text, keys in a fixed order, every double in the shortest form that reads back the
/// same. Bytes of strings that are no UTF-8 become U+FFFD.
std::string vdag_metadata_json(const VdagMetadata& metadata);

/// Reads it back. Throws Error("", place, reason) where it is no JSON, a value is missing, of the
/// wrong type or out of range (levels, a finite origin, positive finite sizes).
VdagMetadata parse_vdag_metadata(std::string_view json);

}  // namespace voxdag
