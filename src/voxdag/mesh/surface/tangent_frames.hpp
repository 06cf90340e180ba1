#pragma once
/// The directions of the axes of tangent-space normal maps.
///
/// After M. Mikkelsen, "Simulation of Wrinkled Surfaces Revisited" (2008): the tangent of a corner
/// is the mean of the tangents of the triangles around the vertex that agree in position, normal,
/// texture coordinates and handedness, weighted by angle.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "voxdag/core/angles.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/core/vec.hpp"
#include "voxdag/mesh/appearance.hpp"
#include "voxdag/mesh/mesh.hpp"

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
  return static_cast<float>(arc_cosine(std::clamp((trace - 1) / 2, -1.0f, 1.0f)));
}

/// The tangents of one triangle.
struct CornerTangents {
  const Vec3f* tangents = nullptr;  ///< Per corner, unit length, along +u. Null: the triangle's
                                    ///< texture coordinates span no area.
  float handedness = 1;  ///< handedness * cross(normal, tangent) points to the image's upper edge.
};

class TangentTable {
 public:
  TangentTable() = default;
  /// Computes tangents for the triangles for which `uv_transform(triangle)` is not null. Throws
  /// Cancelled and OverMemory.
  TangentTable(const Mesh& mesh, const Appearance& appearance,
               const std::function<const UvTransform*(std::size_t triangle)>& uv_transform,
               Work work = {});

  CornerTangents operator[](std::size_t triangle) const {
    if (places_.empty() || places_[triangle] == kNone) return {};
    const std::uint32_t place = places_[triangle];
    return {tangents_.data() + 3 * std::size_t{place & ~kMirrored},
            (place & kMirrored) != 0 ? -1.0f : 1.0f};
  }
  std::uint64_t bytes() const {
    return places_.size() * sizeof(std::uint32_t) + tangents_.size() * sizeof(Vec3f);
  }

 private:
  static constexpr std::uint32_t kNone = ~0u, kMirrored = 1u << 31;

  CountedVector<std::uint32_t> places_;  ///< Per triangle: index into `tangents_`, with kMirrored.
  CountedVector<Vec3f> tangents_;
};

/// Returns the unit normal of a triangle's plane; zero if the triangle has no area.
Vec3f face_normal(const Mesh& mesh, std::size_t triangle);

}  // namespace voxdag
