#pragma once
/// A volume that encloses a piece of a displaced triangle for every tessellation.
#include <algorithm>
#include <array>
#include <cmath>

#include "voxdag/core/box.hpp"
#include "voxdag/core/interval.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {

/// Contains the points of a flat triangle, moved along the interpolated normals of its corners by
/// heights between two bounds, and moved by up to `slack` in any direction.
struct DisplacedPiece {
  std::array<Vec3d, 3> corners;    ///< Flat triangle, world units.
  std::array<double, 3> reach{};   ///< Bound on how far each corner moves.
  std::array<Vec3f, 3> normals{};  ///< Unit length, or zero.
  float shortest = 1;              ///< No mean of the normals is shorter than this.
  Interval heights{0, 0};
  double slack = 0;

  /// Returns the least and greatest dot(direction, p) of all points p in the volume.
  Interval along(Vec3d direction) const {
    std::array<double, 3> at;
    std::array<float, 3> component;
    for (std::size_t i = 0; i < 3; ++i) {
      at[i] = dot(direction, corners[i]);
      component[i] = dot(static_cast<Vec3f>(direction), normals[i]);
    }
    return interval_along(at, component, std::sqrt(dot(direction, direction)));
  }

  Box3d box() const {
    const auto along_axis = [&](int axis) {
      return interval_along({corners[0][axis], corners[1][axis], corners[2][axis]},
                            {normals[0][axis], normals[1][axis], normals[2][axis]}, 1);
    };
    const Interval x = along_axis(0), y = along_axis(1), z = along_axis(2);
    return {{x.lo, y.lo, z.lo}, {x.hi, y.hi, z.hi}};
  }

  /// Returns the area vector of the flat triangle: half of the cross product of two edges.
  Vec3d area() const { return cross(corners[1] - corners[0], corners[2] - corners[0]) * 0.5; }

 private:
  /// Returns along() for a direction of this length. `at` and `component` are the components of
  /// corners and normals along it.
  Interval interval_along(const std::array<double, 3>& at, const std::array<float, 3>& component,
                          double length) const {
    const auto [least, most] = std::minmax({component[0], component[1], component[2]});
    const Interval normal{least < 0 ? least / shortest : least, most > 0 ? most / shortest : most};
    const Interval offset = normal * heights;
    Interval all{std::min({at[0], at[1], at[2]}) + offset.lo - slack * length,
                 std::max({at[0], at[1], at[2]}) + offset.hi + slack * length};
    for (std::size_t i = 0; i < 3; ++i) {
      const double far = reach[i] * length;
      all = {std::min(all.lo, at[i] - far), std::max(all.hi, at[i] + far)};
    }
    return all;
  }
};

}  // namespace voxdag
