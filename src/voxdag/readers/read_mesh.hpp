#pragma once
/// Reads any mesh file.
#include <filesystem>
#include <string_view>

#include "voxdag/mesh/appearance.hpp"
#include "voxdag/readers/read_options.hpp"

namespace voxdag {

/// Reads a mesh. The content decides the format where it is certain (PLY, glTF, STL, OFF), else the
/// extension does: OBJ, PLY, STL, glTF and OFF have readers here, assimp reads other formats if the
/// library was built with it. docs/meshes.md lists what is read from each format.
///
/// Every index of the mesh is in range, every vertex that a triangle uses is finite, and there is
/// at least one triangle. The result depends on the file alone, not on the number of threads.
///
/// Memory: with ReadOptions::memory set, reads within that budget and leaves memory_bytes(mesh)
/// reserved, which the caller releases when it frees the mesh. Pages of mapped files do not count:
/// they are released as they are read.
///
/// Throws Error with the line, byte or JSON value at fault, OverMemory with the file's name, and
/// Cancelled.
Mesh read_mesh(const std::filesystem::path& path, const ReadOptions& options = {});

/// Reads the mesh that read_mesh gives and its appearance, in one pass. Images are named or copied,
/// not decoded. A missing or malformed attribute is a warning, not an error; a name of a file
/// outside of the mesh file's folder is an error unless ReadOptions::allow_outside is set. Leaves
/// memory_bytes of mesh and appearance reserved.
MeshWithAppearance read_mesh_with_appearance(const std::filesystem::path& path,
                                             const ReadOptions& options = {});

inline Mesh read_mesh(const std::filesystem::path& path, Progress* progress) {
  return read_mesh(path, ReadOptions{.progress = progress});
}
inline MeshWithAppearance read_mesh_with_appearance(const std::filesystem::path& path,
                                                    Progress* progress) {
  return read_mesh_with_appearance(path, ReadOptions{.progress = progress});
}

enum class MeshFormat { kObj, kPly, kStl, kGltf, kOff, kOther };

/// Returns the format of a file from its bytes and its extension (".obj", any case).
MeshFormat detect_mesh_format(std::string_view bytes, std::string_view extension);

}  // namespace voxdag
