#pragma once
/// Finds triangles that repeat others with their appearance.
#include "voxdag/core/parallel/find_duplicates.hpp"
#include "voxdag/mesh/appearance.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// Returns the triangles for which one with a lower index has the same corners, in the same
/// direction of rotation, with the same appearance: the material and, by corner, normals, texture
/// coordinates and colours. Without `appearance` (null) only the positions are compared. Cost,
/// errors and progress are those of find_duplicates.
IndexSet find_duplicate_surfaces(const Mesh& mesh, const Appearance* appearance, Work work = {});

}  // namespace voxdag
