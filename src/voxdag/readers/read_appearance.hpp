#pragma once
/// Any mesh file, with what it says of the look of its surface.
#include <filesystem>
#include <string>
#include <vector>

#include "voxdag/mesh/appearance.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

struct MeshWithAppearance {
  Mesh mesh;
  Appearance appearance;
  std::vector<std::string> warnings;  ///< One line each: what could not be had, and what stands in.
};

/// Reads a mesh, which is the very one that read_mesh gives, and its attributes; docs/meshes.md
/// says which formats have which. Images are named or copied, not decoded. What is missing or
/// malformed among the attributes is a warning, never an error; the mesh itself is checked as by
/// read_mesh. Memory: beside the mesh, up to 68 bytes per triangle and, while it reads, 24 bytes
/// per normal, texture coordinate and coloured vertex of the file.
MeshWithAppearance read_mesh_with_appearance(const std::filesystem::path& path,
                                             Progress* progress = nullptr);

}  // namespace voxdag
