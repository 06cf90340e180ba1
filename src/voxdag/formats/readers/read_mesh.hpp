#pragma once
/// Reads any mesh file.
#include <filesystem>
#include <string_view>

#include "voxdag/formats/readers/read_options.hpp"
#include "voxdag/mesh/appearance.hpp"
#include "voxdag/mesh/input_transform.hpp"

namespace voxdag {

/// Reads a mesh. Files that gzip or Zstandard have compressed, and pipes, are unpacked to memory
/// first (InputFile). The content decides the format if it is certain (PLY, glTF, STL, OFF),
/// else the extension does. OBJ, PLY, STL, glTF, OFF, 3MF and COLLADA have readers here; assimp
/// reads other formats if the library was built with it. docs/meshes.md lists the features of each
/// format that are read.
///
/// Every index of the mesh is in range, every vertex that a triangle uses is finite, and there is
/// at least one triangle: triangles with a vertex that is not finite are left out with a warning.
/// The result depends on the file alone, not on the number of threads.
///
/// A mesh that is far from 0 (float_origin() in core/float_origin.hpp) is read a second time: its
/// vertices are measured from Mesh::origin before they are rounded to float32.
///
/// Memory: if ReadOptions::work has a budget, reads within it. memory_bytes(mesh) stay reserved;
/// the caller releases them when it frees the mesh. Pages of mapped files do not count: they are
/// released as they are read. With ReadOptions::arrays, a mesh can be larger than memory: its
/// arrays are in files, and few of their pages stay resident.
///
/// Throws Error with the line, byte or JSON value at fault, Error with the folder's name if the
/// folder of ReadOptions::arrays is full, OverMemory with the file's name, and Cancelled.
Mesh read_mesh(const std::filesystem::path& path, const ReadOptions& options = {});

/// Reads a mesh as read_mesh() does, and its appearance, in one pass. Image files are named,
/// embedded images copied; none is decoded. A missing or malformed attribute is a warning, not an
/// error. The name of a file outside the mesh file's folder is an error unless
/// ReadOptions::allow_outside is set. memory_bytes() of mesh and appearance stay reserved.
MeshWithAppearance read_mesh_with_appearance(const std::filesystem::path& path,
                                             const ReadOptions& options = {});

/// Returns the up axis and the unit of a mesh's coordinates: those that the file says (COLLADA),
/// else the customs of its format. Opens the file only if the extension does not tell them. Throws
/// Error.
FormatCustom mesh_custom(const std::filesystem::path& path, const ReadOptions& options = {});

enum class MeshFormat { kObj, kPly, kStl, kGltf, kOff, k3mf, kCollada, kOther };

/// Returns the format of a file from its bytes and its extension (".obj", any case).
MeshFormat detect_mesh_format(std::string_view bytes, std::string_view extension);

}  // namespace voxdag
