#pragma once
/// Reads other mesh formats through the Open Asset Import Library, if voxdag was built with it.
#include "voxdag/formats/readers/mesh_source.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// Reads the triangles of the scene, node transforms applied; triangulates polygons, leaves out
/// points and lines. `extension` (".dxf") chooses the importer; without one the content does.
///
/// Unless options.any_assimp_importer is set, only the importers that survived fuzzing are used.
/// Assimp may open only files inside the mesh's folder, or any file if options.allow_outside is
/// set. Memory: reserves 64 bytes per byte of the file, because assimp's own memory cannot be
/// counted, and the mesh. Cannot be cancelled while assimp works.
///
/// Throws Error if the format is unknown or needs options.any_assimp_importer, if assimp refuses
/// the file (with its reason), or if this library was built without assimp. Throws OverMemory.
Mesh read_with_assimp(const MeshSource& source, const std::string& extension);

}  // namespace voxdag
