#pragma once
/// The attributes of a PLY file.
#include <string>
#include <vector>

#include "voxdag/mesh/appearance.hpp"
#include "voxdag/readers/mesh_bytes.hpp"

namespace voxdag {

/// Reads what belongs to `mesh`, which read_ply made of the same bytes. Of vertices: `red green
/// blue` with or without `alpha` (or `diffuse_red` ...; sRGB, integers over their type's greatest
/// value), `nx ny nz`, and `s t`, `u v`, `texture_u texture_v` or `texture_s texture_t`. Of faces:
/// the colours, where vertices have none, and the list `texcoord` of six numbers per triangle
/// (MeshLab). A comment `TextureFile NAME` is the colour texture of all. Appends to `warnings`.
Appearance read_ply_appearance(const MeshBytes& source, const Mesh& mesh,
                               std::vector<std::string>& warnings);

}  // namespace voxdag
