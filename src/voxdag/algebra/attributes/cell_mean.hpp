#pragma once
/// The values of a cell, and the mean of the values of cells.
///
/// A mean is weighted. If all values of a kind are equal, their mean is that value. Otherwise:
///
///   colours     are averaged in linear light, in double, and rounded to sRGB codes
///   normals     give the direction of their sum; if that is shorter than half of the sum of their
///               lengths, the value with the largest weight counts, the first of equal ones
///   materials   the one with the largest weight, the smallest id of equal ones
#include <utility>
#include <vector>

#include "voxdag/stored/attributes/stored_attributes.hpp"

namespace voxdag {

/// The values of one cell. Those of kinds that it does not have mean nothing.
struct CellValues {
  Value8 color{}, normal{};
  std::uint16_t material = 0;

  friend bool operator==(const CellValues&, const CellValues&) = default;
};

/// Which kinds of values the cells of a DAG have.
struct ValueKinds {
  bool colors = false, normals = false;
  std::uint32_t materials = 0;  ///< Ids are less than this, at most kMaxMaterials; 0: no ids.

  bool is_empty() const { return !colors && !normals && materials == 0; }
  friend bool operator==(const ValueKinds&, const ValueKinds&) = default;
};

inline ValueKinds kinds_of(const DagAttributesView& attributes) {
  return {attributes.has_colors(), attributes.has_normals(),
          attributes.has_materials() ? attributes.materials.materials : 0};
}

/// Sums values up. The order of the calls matters only for rounding and for equal weights.
class CellMean {
 public:
  explicit CellMean(const ValueKinds& kinds) : kinds_(kinds) {}

  /// Adds values with a weight of at least 1.
  void add(const CellValues& values, std::uint64_t weight);
  /// Returns the mean. There must be values.
  CellValues result() const;

 private:
  Value8 mean_color() const;
  Value8 mean_normal() const;
  std::uint16_t largest_material() const;

  ValueKinds kinds_;
  CellValues first_, heaviest_;
  std::uint64_t weight_ = 0, most_ = 0;
  bool has_one_color_ = true, has_one_normal_ = true;
  Vec3d color_{}, normal_{};
  std::vector<std::pair<std::uint16_t, std::uint64_t>> materials_;  // other than that of first_
};

}  // namespace voxdag
