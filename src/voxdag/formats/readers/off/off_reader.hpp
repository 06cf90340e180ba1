#pragma once
/// OFF, the Object File Format of Geomview, as text.
#include "voxdag/formats/readers/mesh_source.hpp"
#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// Returns whether the bytes start with the magic word of an OFF file: OFF, COFF, NOFF, STOFF ...
bool is_off(std::string_view bytes);

/// Reads the first three numbers of each vertex and the vertex indices of each face, one vertex or
/// face per line. Ignores the rest of the line (normals) and comments from '#' on. If that fails,
/// reads all numbers as one list, which must end with the last face, and adds a warning. The number
/// of edges may be missing, and, with a warning, the word OFF before the counts. Cuts polygons with
/// cut_polygon() and ignores those of fewer than three corners.
///
/// With its appearance: reads the colours of vertices (COFF) and those that three or four numbers
/// after the indices of a face give; those of faces precede. They are sRGB, 0 to 1 or 0 to 255: see
/// plain_color_scale(). Ignores alpha. The rest is grey.
///
/// Throws Error with the line: malformed lines, counts that need a longer file, indices out of
/// range, the binary and higher-dimensional variants. Throws Error if there are no triangles.
MeshWithAppearance read_off(const MeshSource& source, ReadParts parts);

}  // namespace voxdag
