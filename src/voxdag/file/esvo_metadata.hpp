#pragma once
/// The metadata of an ESVO in a .vdag file: the JSON of its META chunk.
#include <cstdint>
#include <string>
#include <string_view>

#include "voxdag/file/scene_metadata.hpp"
#include "voxdag/stored/esvo/esvo_counts.hpp"

namespace voxdag {

struct EsvoMetadata : SceneMetadata {
  std::uint64_t root = 0;  ///< Slot of the root's descriptor in the chunk ESVO.
  EsvoCounts counts;
  friend bool operator==(const EsvoMetadata&, const EsvoMetadata&) = default;
};

/// Returns the JSON text; see vdag_metadata_json().
std::string esvo_metadata_json(const EsvoMetadata& metadata);

/// Parses the JSON text; see parse_vdag_metadata() for errors.
EsvoMetadata parse_esvo_metadata(std::string_view json);

}  // namespace voxdag
