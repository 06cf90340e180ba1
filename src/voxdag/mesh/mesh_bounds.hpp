#pragma once
/// The bounding box of a mesh.
#include "voxdag/core/box.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// Returns the bounds of the vertices that triangles reference, in world units; the empty box if
/// there are no triangles.
inline Box3d referenced_bounds(const Mesh& mesh) {
  Box3f bounds = Box3f::empty();
  for (const Triangle& triangle : mesh.triangles)
    for (std::uint32_t index : triangle) bounds.extend(mesh.vertices[index]);
  if (bounds.is_empty()) return Box3d::empty();
  return {mesh.to_world(bounds.lo), mesh.to_world(bounds.hi)};
}

}  // namespace voxdag
