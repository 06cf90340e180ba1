#pragma once
/// Any mesh file.
#include <filesystem>
#include <string_view>

#include "voxdag/mesh/mesh.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

/// Reads a mesh. Content decides the format where it is certain (PLY, glTF, STL, OFF), the
/// extension elsewhere: obj, ply, stl, gltf, glb and off by this library's own readers, everything
/// else by assimp where the library was built with it. See docs/meshes.md for what each format
/// gives.
///
/// Every index of the mesh is in range, every vertex that a triangle uses is finite, and there is
/// at least one triangle. The result depends on the file alone, not on the number of threads.
/// Throws Error with the line or byte for what is not such a mesh, and Cancelled.
Mesh read_mesh(const std::filesystem::path& path, Progress* progress = nullptr);

enum class MeshFormat { kObj, kPly, kStl, kGltf, kOff, kOther };

/// The format of a file, from its bytes and its extension (".obj", any case).
MeshFormat detect_mesh_format(std::string_view bytes, std::string_view extension);

}  // namespace voxdag
