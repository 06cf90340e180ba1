#pragma once
/// Affine maps of points, directions and normals, in double.
#include <array>

#include "voxdag/core/vec.hpp"

namespace voxdag {

/// An affine map: columns x, y, z and the translation.
struct AffineTransform {
  std::array<Vec3d, 4> columns{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}};

  Vec3d direction(Vec3d v) const { return columns[0] * v.x + columns[1] * v.y + columns[2] * v.z; }
  Vec3d point(Vec3d p) const { return direction(p) + columns[3]; }
  /// Returns whether the map turns left into right, so that it turns triangles over.
  bool is_mirroring() const { return dot(columns[0], cross(columns[1], columns[2])) < 0; }
  /// Maps a normal with the inverse transpose, up to a positive factor. Returns zero if the map
  /// flattens space to less than a plane.
  Vec3d normal(Vec3d n) const {
    const Vec3d x = cross(columns[1], columns[2]), y = cross(columns[2], columns[0]),
                z = cross(columns[0], columns[1]);
    const Vec3d mapped = x * n.x + y * n.y + z * n.z;
    return dot(columns[0], x) < 0 ? -mapped : mapped;
  }
  friend AffineTransform operator*(const AffineTransform& a, const AffineTransform& b) {
    return {{a.direction(b.columns[0]), a.direction(b.columns[1]), a.direction(b.columns[2]),
             a.point(b.columns[3])}};
  }
};

}  // namespace voxdag
