#pragma once
/// The directions of the axes of tangent-space normal maps.
///
/// After M. Mikkelsen, "Simulation of Wrinkled Surfaces Revisited" (2008): the tangent of a corner
/// is the mean of the tangents of the triangles around the vertex that agree in position, normal,
/// texture coordinates and handedness, weighted by angle.
#include <cstdint>
#include <functional>
#include <vector>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/core/vec.hpp"
#include "voxdag/mesh/appearance.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

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
