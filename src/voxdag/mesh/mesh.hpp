#pragma once
/// An indexed triangle mesh.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "voxdag/core/vec.hpp"

namespace voxdag {

using Triangle = std::array<std::uint32_t, 3>;  ///< Three indices into Mesh::vertices.

/// A mesh from a reader has only indices in range, and every vertex that a triangle references is
/// finite.
struct Mesh {
  std::vector<Vec3f> vertices;  ///< World units, float32 as in the file (correctly rounded).
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> triangle_materials;  ///< Index into `materials`, or empty: no names.
  std::vector<std::string> materials;             ///< Names as in the file.
};

}  // namespace voxdag
