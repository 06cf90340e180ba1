#pragma once
/// Moves the vertices of a mesh without a loss of digits.
#include "voxdag/core/float_origin.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// Sets each vertex i to `position(i)`, in world units, and the origin to that of the new bounds.
/// `position` may call Mesh::position(i).
template <class Position>
void place_vertices(Mesh& mesh, const Position& position) {
  Box3d bounds = Box3d::empty();
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) bounds.extend(position(vertex));
  const Vec3d origin = float_origin(bounds);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    mesh.vertices[i] = static_cast<Vec3f>(position(i) - origin);
  mesh.origin = origin;
}

}  // namespace voxdag
