#pragma once
/// Reads a binary STL file in chunks.
#include "voxdag/formats/readers/mesh_chunks.hpp"

namespace voxdag {

/// Returns null if read_mesh() must read the file. Throws as open_mesh_chunks() does.
std::unique_ptr<MeshChunks> open_stl_chunks(MappedFile file, const std::filesystem::path& path,
                                            const ReadOptions& options, std::size_t chunk_bytes);

}  // namespace voxdag
