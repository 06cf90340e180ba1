#pragma once
/// Makes sheets of n × n squares, two triangles each.
#include <cstdint>

#include "voxdag/mesh/mesh.hpp"

namespace voxdag::test {

/// Returns a sheet whose vertex in row i and column j, 0 to n, is vertex_at(i, j).
template <class VertexAt>
Mesh grid_mesh(int n, const VertexAt& vertex_at) {
  Mesh mesh;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) mesh.vertices.push_back(vertex_at(i, j));
  const auto at = [n](int i, int j) { return static_cast<std::uint32_t>(i * (n + 1) + j); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
      mesh.triangles.push_back({at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)});
    }
  return mesh;
}

}  // namespace voxdag::test
