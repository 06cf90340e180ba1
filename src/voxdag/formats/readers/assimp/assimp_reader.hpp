#pragma once
/// Reads other mesh formats through the Open Asset Import Library, if voxdag was built with it.
#include "voxdag/formats/readers/mesh_source.hpp"
#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// Reads the triangles of the scene, node transforms applied; triangulates polygons, leaves out
/// points and lines. With an appearance: the colours of materials; textures are left out with a
/// warning. `extension` (".fbx") chooses the importer; without one the content does.
///
/// Hostile files crash several importers, so assimp runs in a ConfinedChild, which opens no file,
/// with 10 s of processor time and 2 s per MiB of the file. It may take 64 bytes per byte of the
/// file and 256 MiB; both count. With options.any_assimp_importer assimp runs in this process: it
/// can open files inside the mesh's folder (any file with options.allow_outside), its memory is
/// counted as 64 bytes per byte of the file, and it cannot be cancelled.
///
/// Throws Error if the format is unknown, if assimp refuses the file (with its reason), crashes or
/// reaches its limits, or if this library was built without assimp. Throws OverMemory, Cancelled.
MeshWithAppearance read_with_assimp(const MeshSource& source, const std::string& extension,
                                    ReadParts parts);

}  // namespace voxdag
