#pragma once
/// STL, binary and ascii.
#include "voxdag/formats/readers/mesh_chunks.hpp"
#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// Reads the facets of every solid. Corners with equal bits become one vertex, numbered in the
/// order of first appearance. Ignores normals and names. A file is binary if its size matches its
/// number of facets, whatever its first word is; else ascii if it starts with "solid" and has no
/// NUL near its start; else binary. Ascii keywords may be in any case; lines may be broken
/// anywhere.
///
/// Adds one warning: about bytes after the last facet; about a count of 0 or 2^32 - 1 in the header
/// of a file whose size fits another count, which is taken; about ascii words "solid" and
/// "endsolid" that are missing or doubled, split ones such as "end loop", and missing normals.
///
/// With its appearance: reads the colours of the facets of binary files. They are VisCAM's (bit 15
/// set; 5 bits each of red, green, blue from bit 14 down), or, if the header has "COLOR=" and RGBA,
/// Magics' (bit 15 not set; red, green, blue from bit 0 up; other facets, and all if no facet sets
/// a bit, have the colour of the header). Facets without a colour are grey.
///
/// Throws Error with the line or byte: malformed text, truncation, 2^32 / 3 facets or more. Throws
/// Error if there are no facets.
MeshWithAppearance read_stl(const MeshSource& source, ReadParts parts);

/// Opens a binary STL file in chunks. Welds the corners of each chunk by itself. Returns null if
/// read_stl() must read the file. Throws as open_mesh_chunks() does.
std::unique_ptr<MeshChunks> open_stl_chunks(MappedFile file, const std::filesystem::path& path,
                                            const ReadOptions& options, std::size_t chunk_bytes);

/// Returns whether the bytes are a binary STL file whose size matches its number of facets.
bool is_exact_binary_stl(std::string_view bytes);
/// Returns whether the bytes start like an ascii STL file: "solid", then a facet or the end of the
/// solid.
bool is_ascii_stl(std::string_view bytes);

}  // namespace voxdag
