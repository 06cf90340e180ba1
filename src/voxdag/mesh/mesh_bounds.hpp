#pragma once
/// The bounding box of a mesh.
#include "voxdag/core/box.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// Returns the bounds of the vertices that triangles reference; the empty box if there are no
/// triangles.
Box3d referenced_bounds(const Mesh& mesh);

}  // namespace voxdag
