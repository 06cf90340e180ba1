#pragma once
/// Writes meshes as PLY files.
#include <filesystem>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// Writes binary little-endian PLY: float x, y, z per vertex and `list uchar uint vertex_indices`
/// per face. With materials each face also has `uint material_index`, and the header names them in
/// lines `comment material INDEX NAME` (control characters in names become spaces). The file
/// appears at `path` only when it is complete. Throws Error if it cannot be written, and Cancelled
/// if `work` is cancelled.
void write_ply(const std::filesystem::path& path, const Mesh& mesh, Work work = {});

}  // namespace voxdag
