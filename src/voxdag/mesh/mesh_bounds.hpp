#pragma once
/// The bounding box of a mesh.
#include "voxdag/core/box.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// Returns the bounds of the vertices that triangles reference; the empty box if there are no
/// triangles.
inline Box3d referenced_bounds(const Mesh& mesh) {
  Box3f bounds = Box3f::empty();
  for (const Triangle& triangle : mesh.triangles)
    for (std::uint32_t index : triangle) bounds.extend(mesh.vertices[index]);
  return {static_cast<Vec3d>(bounds.lo), static_cast<Vec3d>(bounds.hi)};
}

}  // namespace voxdag
