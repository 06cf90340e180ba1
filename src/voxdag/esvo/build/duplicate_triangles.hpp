#pragma once
/// Which triangles of a mesh repeat others exactly.
#include <cstdint>
#include <vector>

#include "voxdag/mesh/appearance.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// Returns for each triangle 1 if an earlier one has the same corners, in the same direction of
/// rotation, with the same appearance: the material and, by corner, normals, texture coordinates
/// and colours. Without `appearance` (null) only the positions are compared. Empty if no triangle
/// is a duplicate.
std::vector<std::uint8_t> find_duplicate_triangles(const Mesh& mesh, const Appearance* appearance);

}  // namespace voxdag
