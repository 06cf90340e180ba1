#pragma once
/// A contour: the pair of parallel planes between which a voxel's surface lies.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 3.2, which gives
/// three 6-bit integers for the normal and two 7-bit integers for the positions.
///
///   | high 7 | low 7 | normal z 6 | normal y 6 | normal x 6 |     bits 31..0
///
/// Let x be the coordinates in which the voxel is [-1,1]³, n the integer normal and |n|1 = |nx| +
/// |ny| + |nz|, the maximum of dot(n, x) in the voxel. Then the surface lies where
///
///   position(low) <= dot(n, x) <= position(high),   position(p) = |n|1 (2p - 127) / 127
///
/// For every normal, the planes of positions 0 and 127 touch corners of the cube.
#include <cassert>
#include <cstdint>

#include "voxdag/core/vec.hpp"

namespace voxdag {

struct Contour {
  static constexpr int kMaxNormal = 31;     ///< The largest absolute value of a component.
  static constexpr int kMaxPosition = 127;  ///< The largest value of low and high.

  std::uint32_t bits = 0;

  /// Packs a contour. `normal` must not be zero, low <= high, and all values must be in range.
  VOXDAG_HD static Contour make(Vec3i normal, int low, int high) {
    assert(0 <= low && low <= high && high <= kMaxPosition);
    const auto field = [](std::int32_t v) { return static_cast<std::uint32_t>(v) & 63u; };
    return {field(normal.x) | field(normal.y) << 6 | field(normal.z) << 12 |
            static_cast<std::uint32_t>(low) << 18 | static_cast<std::uint32_t>(high) << 25};
  }

  VOXDAG_HD Vec3i normal() const { return {component(26), component(20), component(14)}; }
  VOXDAG_HD int low() const { return static_cast<int>(bits >> 18 & 127u); }
  VOXDAG_HD int high() const { return static_cast<int>(bits >> 25); }
  friend bool operator==(const Contour&, const Contour&) = default;

 private:
  /// Returns the six bits below bit 32 - shift as a signed integer.
  VOXDAG_HD std::int32_t component(int shift) const {
    return static_cast<std::int32_t>(bits << shift) >> 26;
  }
};
static_assert(sizeof(Contour) == 4);

/// Returns |n|1, the sum of the components' absolute values.
VOXDAG_HD constexpr std::int32_t length1(Vec3i n) {
  return (n.x < 0 ? -n.x : n.x) + (n.y < 0 ? -n.y : n.y) + (n.z < 0 ? -n.z : n.z);
}

/// Returns the bound of dot(n, x) that `position` (low or high) encodes. T is float or double.
template <class T>
VOXDAG_HD constexpr T contour_position(std::int32_t normal_length1, int position) {
  return static_cast<T>(normal_length1 * (2 * position - Contour::kMaxPosition)) /
         static_cast<T>(Contour::kMaxPosition);
}

}  // namespace voxdag
