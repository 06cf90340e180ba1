#pragma once
/// STL, binary and ascii.
#include "voxdag/formats/readers/mesh_chunks.hpp"

namespace voxdag {

/// Reads the facets of every solid. Corners with equal bits become one vertex, numbered in the
/// order of first appearance. Ignores normals, attributes and names. A file is binary if its size
/// matches its number of facets, whatever its first word is; else ascii if it starts with "solid";
/// else binary, and bytes after the last facet are ignored. Ascii keywords may be in any case;
/// lines may be broken anywhere.
///
/// Throws Error with the line or byte: malformed text, truncation, vertices that are not finite,
/// 2^32 / 3 facets or more. Throws Error if there are no facets.
Mesh read_stl(const MeshSource& source);

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
