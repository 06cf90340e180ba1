#pragma once
/// PLY, the Polygon File Format.
#include "voxdag/formats/readers/mesh_chunks.hpp"
#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// Reads x, y and z of element `vertex` and the list `vertex_indices` (or `vertex_index`) of
/// element `face`, in ascii and in both binary orders; ignores other elements and properties.
/// Without faces, reads the triangle strips of element `tristrips`, which -1 separates. Rounds
/// coordinates of other types to the nearest float32. Cuts polygons with cut_polygon() and ignores
/// those of fewer than three corners. The materials come from comments `material NUMBER NAME`,
/// numbered from 0, and the face property `material_index`; without them, from several comments
/// `TextureFile NAME` and the face property `texnumber`. In ascii, each row is one line.
///
/// With its appearance: reads the properties that PlyAttributes lists; a comment `TextureFile NAME`
/// names the colour texture of all materials, or, with `texnumber`, that of one.
///
/// Throws Error with the line (in a binary body with the byte): malformed headers and values,
/// counts that need a longer file, truncation, references out of range, faces beside triangle
/// strips. Throws Error if there are no triangles.
MeshWithAppearance read_ply(const MeshSource& source, ReadParts parts);

/// Opens a binary PLY file in chunks. Returns null if it is not binary, if faces have other lists
/// than that of their corners, or if other elements have lists. Throws as open_mesh_chunks() does.
std::unique_ptr<MeshChunks> open_ply_chunks(MappedFile file, const std::filesystem::path& path,
                                            const ReadOptions& options, std::size_t chunk_bytes);

}  // namespace voxdag
