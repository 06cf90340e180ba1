#pragma once
/// STL, binary and ascii.
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/readers/mesh_source.hpp"

namespace voxdag {

/// Reads the facets of every solid. Corners with equal bits become one vertex, numbered in the
/// order of first appearance. Normals, attributes and names are passed over. A file is binary if
/// its size is that of the facets that it counts, whatever its first word; else ascii if it starts
/// with "solid"; else binary, and bytes after the last facet are passed over. Ascii keywords may be
/// in any case and lines may be broken anywhere.
///
/// Throws Error with the line or byte: malformed text, truncation, vertices that are not finite,
/// 2^32 / 3 facets or more. Throws Error if there are no facets.
Mesh read_stl(const MeshSource& source);

/// Whether the bytes are a binary STL file of exactly the size that it says.
bool is_exact_binary_stl(std::string_view bytes);
/// Whether the bytes start like an ascii STL file: "solid", and a facet or the end of the solid
/// soon after.
bool is_ascii_stl(std::string_view bytes);

}  // namespace voxdag
