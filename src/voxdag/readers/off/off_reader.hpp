#pragma once
/// OFF, the Object File Format of Geomview, as text.
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/readers/mesh_source.hpp"

namespace voxdag {

/// Whether the bytes start with the magic word of an OFF file: OFF, COFF, NOFF, STOFF and so on.
bool is_off(std::string_view bytes);

/// Reads the first three numbers of each vertex and each face's vertex indices, one per line; what
/// follows them on the line (normals, colours) is passed over, and so are comments from '#' on. A
/// polygon becomes a fan around its first corner, which is exact for convex polygons; polygons of
/// fewer than three corners are left out. Throws Error with the line: malformed lines, counts that
/// the file is too short for, indices out of range, vertices that are used and not finite, the
/// binary and higher-dimensional variants. Throws Error if there are no triangles.
Mesh read_off(const MeshSource& source);

}  // namespace voxdag
