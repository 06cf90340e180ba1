#pragma once
/// Moves the vertices of a mesh without a loss of digits.
#include "voxdag/core/error.hpp"
#include "voxdag/core/float_origin.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// Sets each vertex i to `position(i)`, in world units, and Mesh::origin to float_origin() of the
/// new bounds, each coordinate rounded to float32. `position` may read vertex i and Mesh::origin;
/// threads call it. Throws Error if a vertex that a triangle uses leaves the range of float32, and
/// Cancelled.
template <class Position>
void place_vertices(Mesh& mesh, const Position& position, Work work = {}) {
  Box3f bounds = Box3f::empty();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    work.poll_seldom(t);
    for (const std::uint32_t vertex : mesh.triangles[t]) {
      const auto rounded = static_cast<Vec3f>(position(vertex));
      if (!is_finite(rounded))
        throw Error("scaled and moved like this, vertices leave the range of float32");
      bounds.extend(rounded);
    }
  }
  const Vec3d origin = float_origin({static_cast<Vec3d>(bounds.lo), static_cast<Vec3d>(bounds.hi)});
  polled_for(mesh.vertices.size(), 4096, work, "move",
             [&](std::size_t i) { mesh.vertices[i] = static_cast<Vec3f>(position(i) - origin); });
  mesh.origin = origin;
}

}  // namespace voxdag
