#pragma once
/// The metadata of a DAG in a .vdag file: the JSON of its META chunk.
#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/file/scene_metadata.hpp"
#include "voxdag/stored/attributes/coarsen_attributes.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"

namespace voxdag {

/// Describes the attributes of the DAG's cells. Without attributes, all members are 0 or empty.
struct AttributesMetadata {
  /// The bound that the encoder kept, and the differences between given and stored values.
  struct Values {
    double bound = 0;  ///< For colours from 0 to 1, for normals in degrees.
    /// For colours, the sum of the squared differences of all channels, in steps of 8 bits. For
    /// normals, the sum of the distances, in 1/256 of a step of 8 bits. Empty: not known.
    std::optional<std::uint64_t> errors;
    friend bool operator==(const Values&, const Values&) = default;
  };
  std::int64_t resolution = 0;  ///< M: cells per side at the finest level with attributes.
  std::optional<Values> colors, normals;
  /// The names of the materials, by id.
  std::optional<std::vector<std::string>> materials;
  /// The labels for which the materials stand, by id (`import --labels`); empty: they stand for
  /// none. From -2^53 to 2^53.
  std::vector<std::int64_t> labels;

  /// Returns m, the finest level with attributes; there must be some.
  int level() const { return std::countr_zero(static_cast<std::uint64_t>(resolution)); }

  /// Returns the peak signal-to-noise ratio of the colours of `cells` cells, in dB; infinity if all
  /// are exact. The errors must be known.
  double color_psnr_db(std::uint64_t cells) const;
  /// Returns the mean angle between given and stored normals of `cells` cells, in degrees: an
  /// estimate from their distances, which is good for small angles. The errors must be known.
  double normal_mean_degrees(std::uint64_t cells) const;
  friend bool operator==(const AttributesMetadata&, const AttributesMetadata&) = default;
};

struct VdagMetadata : SceneMetadata {
  SvdagCounts counts;
  AttributesMetadata attributes;
  friend bool operator==(const VdagMetadata&, const VdagMetadata&) = default;
};

/// Returns the id of the material that has a name, or a label written as a number, or without
/// labels the id itself; nothing if there is none.
std::optional<std::size_t> find_material(const AttributesMetadata& attributes,
                                         std::string_view wanted);

/// Returns the JSON text: keys in a fixed order, every double in the shortest form that reads back
/// as the same value. Bytes of strings that are not UTF-8 become U+FFFD.
std::string vdag_metadata_json(const VdagMetadata& metadata);

/// Parses the JSON text. Throws Error("", place, reason) if it is not JSON, or if a value is
/// missing, of the wrong type or out of range: levels, a finite origin, positive finite sizes.
VdagMetadata parse_vdag_metadata(std::string_view json);

/// Returns the metadata for the grid of fewer levels that `dag` has, whose voxels are `dag`; see
/// coarsen() in algebra/coarsen.hpp. `build` gets the key "coarsened_from".
VdagMetadata coarser_metadata(VdagMetadata metadata, const SvdagView& dag);

/// Changes the description of attributes, which must have some, to that of the attributes that
/// coarsen_attributes() makes of them within these bounds for a grid of `levels` levels. The errors
/// of values that are encoded again are not known.
void describe_coarser(AttributesMetadata& attributes, int levels, const CoarsenBounds& bounds = {});

}  // namespace voxdag
