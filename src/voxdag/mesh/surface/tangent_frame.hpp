#pragma once
/// The axes of tangent space at a point of a surface.
#include <algorithm>
#include <cmath>

#include "voxdag/core/vec.hpp"

namespace voxdag {

inline Vec3f unit_or_zero(Vec3f v) {
  const float length2 = dot(v, v);
  return length2 > 0 ? v * (1 / std::sqrt(length2)) : Vec3f{};
}

/// Orthogonal axes of unit length.
struct TangentFrame {
  Vec3f tangent, bitangent, normal;

  Vec3f to_world(Vec3f v) const { return tangent * v.x + bitangent * v.y + normal * v.z; }
  Vec3f to_local(Vec3f v) const { return {dot(tangent, v), dot(bitangent, v), dot(normal, v)}; }
};

/// Returns the frame of a unit normal, with the tangent made orthogonal to it. `handedness` is 1 or
/// -1: the sign of the bitangent.
inline TangentFrame make_frame(Vec3f normal, Vec3f tangent, float handedness) {
  tangent = tangent - normal * dot(normal, tangent);
  if (dot(tangent, tangent) < 1e-12f) {
    const Vec3f other = std::abs(normal.x) < 0.7f ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0};
    tangent = cross(other, normal);
  }
  tangent = unit_or_zero(tangent);
  return {tangent, cross(normal, tangent) * handedness, normal};
}

/// Returns the angle of the rotation from one frame to the other, in radians.
inline float angle_between(const TangentFrame& a, const TangentFrame& b) {
  const float trace =
      dot(a.tangent, b.tangent) + dot(a.bitangent, b.bitangent) + dot(a.normal, b.normal);
  return std::acos(std::clamp((trace - 1) / 2, -1.0f, 1.0f));
}

}  // namespace voxdag
