#pragma once
/// Wavefront OBJ.
#include "voxdag/formats/readers/mesh_chunks.hpp"
#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// Reads vertices (`v`), polygons (`f`, every form of reference, negative ones too) and the names
/// of materials (`usemtl`). Cuts polygons with cut_polygon(). Ignores points, lines, free-form
/// curves and surfaces, polygons of fewer than three corners, and the fourth number of a vertex.
/// Faces may come before their vertices. A backslash at the end of a line continues it.
///
/// With its appearance: reads `vt`, `vn`, colours that follow a vertex's coordinates (`v x y z r g
/// b`, sRGB, 0 to 1 or 0 to 255: see plain_color_scale()) and the MTL files of `mtllib`. A corner
/// whose `vt` or `vn` does not exist has no texture coordinates or normal. A vertex without a
/// colour keeps that of its material.
///
/// Throws Error with the line: malformed vertices or faces, references out of range. Throws Error
/// if there are no triangles.
MeshWithAppearance read_obj(const MeshSource& source, ReadParts parts);

/// Opens an OBJ file in chunks. Throws as open_mesh_chunks() does.
std::unique_ptr<MeshChunks> open_obj_chunks(MappedFile file, const std::filesystem::path& path,
                                            const ReadOptions& options, std::size_t chunk_bytes);

}  // namespace voxdag
