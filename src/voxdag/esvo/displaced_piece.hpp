#pragma once
/// What encloses a piece of a displaced triangle, however finely it is tessellated.
#include <algorithm>
#include <array>
#include <cmath>

#include "voxdag/core/box.hpp"
#include "voxdag/core/vec.hpp"
#include "voxdag/esvo/interval.hpp"

namespace voxdag {

/// Its points are those of a flat triangle, moved along normals between those of its corners, by
/// heights between two bounds; and by `slack` in any direction.
struct DisplacedPiece {
  std::array<Vec3d, 3> corners;    ///< Of the flat triangle, world units.
  std::array<double, 3> reach{};   ///< How far a corner may be moved in any direction.
  std::array<Vec3f, 3> normals{};  ///< Unit length, or zero.
  float shortest = 1;              ///< No mean of the normals is shorter than this.
  Interval heights{0, 0};
  double slack = 0;

  /// The least and the greatest dot(direction, p) that any point p can have.
  Interval along(Vec3d direction) const {
    Vec3d at;
    Vec3f component;
    const double length = std::sqrt(dot(direction, direction));
    for (int i = 0; i < 3; ++i) {
      at[i] = dot(direction, corners[static_cast<std::size_t>(i)]);
      component[i] = dot(static_cast<Vec3f>(direction), normals[static_cast<std::size_t>(i)]);
    }
    const auto [least, most] = std::minmax({component.x, component.y, component.z});
    const Interval normal{least < 0 ? least / shortest : least, most > 0 ? most / shortest : most};
    const Interval offset = normal * heights;
    Interval all{std::min({at.x, at.y, at.z}) + offset.lo - slack * length,
                 std::max({at.x, at.y, at.z}) + offset.hi + slack * length};
    for (int i = 0; i < 3; ++i) {
      const double far = reach[static_cast<std::size_t>(i)] * length;
      all = {std::min(all.lo, at[i] - far), std::max(all.hi, at[i] + far)};
    }
    return all;
  }

  Box3d box() const {
    const Interval x = along({1, 0, 0}), y = along({0, 1, 0}), z = along({0, 0, 1});
    return {{x.lo, y.lo, z.lo}, {x.hi, y.hi, z.hi}};
  }

  /// Half of the cross product of two edges of the flat triangle.
  Vec3d area() const { return cross(corners[1] - corners[0], corners[2] - corners[0]) * 0.5; }
};

}  // namespace voxdag
