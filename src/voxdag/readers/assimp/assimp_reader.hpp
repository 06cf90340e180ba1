#pragma once
/// Every other mesh format, through the Open Asset Import Library where it is installed.
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/readers/mesh_source.hpp"

namespace voxdag {

/// Reads the triangles of the scene, node transforms applied; polygons are triangulated, points and
/// lines left out. `extension` (".off") says which of assimp's readers; without one assimp goes by
/// the content. Throws Error for what assimp refuses, with its reason, for formats that it does not
/// know, and where this library was built without assimp.
Mesh read_with_assimp(const MeshSource& source, const std::string& extension);

}  // namespace voxdag
