#pragma once
/// The attributes of a Wavefront OBJ file.
#include <string>
#include <vector>

#include "voxdag/mesh/appearance.hpp"
#include "voxdag/readers/mesh_bytes.hpp"

namespace voxdag {

/// Reads what belongs to `mesh`, which read_obj made of the same bytes: `vt`, `vn`, colours behind
/// the coordinates of vertices (`v x y z r g b`, taken as sRGB), and the MTL files of `mtllib`
/// beside it. Appends to `warnings` what is missing; a corner whose `vt` or `vn` does not exist has
/// none.
Appearance read_obj_appearance(const MeshBytes& source, const Mesh& mesh,
                               std::vector<std::string>& warnings);

}  // namespace voxdag
