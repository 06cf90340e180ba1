#pragma once
/// The metadata of a DAG in a .vdag file: the JSON of its META chunk.
#include <string>
#include <string_view>

#include "voxdag/file/scene_metadata.hpp"
#include "voxdag/layout/svdag_counts.hpp"

namespace voxdag {

struct VdagMetadata : SceneMetadata {
  SvdagCounts counts;
  friend bool operator==(const VdagMetadata&, const VdagMetadata&) = default;
};

/// Returns the JSON text: keys in a fixed order, every double in the shortest form that reads back
/// as the same value. Bytes of strings that are not UTF-8 become U+FFFD.
std::string vdag_metadata_json(const VdagMetadata& metadata);

/// Parses the JSON text. Throws Error("", place, reason) if it is not JSON, or if a value is
/// missing, of the wrong type or out of range: levels, a finite origin, positive finite sizes.
VdagMetadata parse_vdag_metadata(std::string_view json);

}  // namespace voxdag
