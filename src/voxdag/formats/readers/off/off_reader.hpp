#pragma once
/// OFF, the Object File Format of Geomview, as text.
#include "voxdag/formats/readers/mesh_source.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// Returns whether the bytes start with the magic word of an OFF file: OFF, COFF, NOFF, STOFF ...
bool is_off(std::string_view bytes);

/// Reads the first three numbers of each vertex and the vertex indices of each face, one vertex or
/// face per line. Ignores the rest of the line (normals, colours) and comments from '#' on. Cuts
/// polygons with cut_polygon() and ignores those of fewer than three corners.
///
/// Throws Error with the line: malformed lines, counts that need a longer file, indices out of
/// range, used vertices that are not finite, the binary and higher-dimensional variants. Throws
/// Error if there are no triangles.
Mesh read_off(const MeshSource& source);

}  // namespace voxdag
