#pragma once
/// Reads other mesh formats through the Open Asset Import Library, if voxdag was built with it.
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/readers/mesh_source.hpp"

namespace voxdag {

/// Reads the triangles of the scene, node transforms applied; triangulates polygons, leaves out
/// points and lines. `extension` (".dxf") chooses the importer; without one the content does.
///
/// Unless options.any_assimp_importer is set, only the importers of importer_choice.hpp are used.
/// Of the files that the mesh names, assimp sees those inside its folder, or all if
/// options.allow_outside is set. Memory: reserves 64 bytes per byte of the file for assimp, whose
/// memory is not counted otherwise, and the mesh. Cannot be cancelled while assimp works.
///
/// Throws Error for formats that are unknown or need options.any_assimp_importer, for files that
/// assimp refuses, with its reason, and if this library was built without assimp; and OverMemory.
Mesh read_with_assimp(const MeshSource& source, const std::string& extension);

}  // namespace voxdag
