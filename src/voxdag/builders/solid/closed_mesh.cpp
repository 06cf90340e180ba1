#include "voxdag/builders/solid/closed_mesh.hpp"

#include "voxdag/builders/solid/mesh_edges.hpp"

namespace voxdag {

OddEdges find_odd_edges(const QuantizedMesh& mesh, Work work) {
  const PageVector<std::uint64_t> hashes = sorted_edge_keys(mesh, work, hash_of_edge);
  OddEdges odd;
  std::uint64_t first_odd = 0;
  for (std::size_t i = 0; i < hashes.size() && hashes[i] != kNoEdge;) {
    std::size_t end = i;
    while (end < hashes.size() && hashes[end] == hashes[i]) ++end;
    if ((end - i) % 2 != 0 && odd.count++ == 0) first_odd = hashes[i];
    i = end;
  }
  for (std::size_t i = 0; i < mesh.mesh_triangle_count() && odd.count > 0; ++i) {
    bool is_found = false;
    each_edge(mesh, i, [&](Vec3i a, Vec3i b) {
      if (is_found || hash_of_edge(a, b) != first_odd) return;
      is_found = true;
      odd.a = a, odd.b = b;
    });
    if (is_found) break;
  }
  return odd;
}

}  // namespace voxdag
