#include "voxdag/solid/closed_mesh.hpp"

#include <algorithm>

#include "voxdag/core/page_vector.hpp"
#include "voxdag/parallel/polled_for.hpp"
#include "voxdag/parallel/polled_sort.hpp"
#include "voxdag/solid/mesh_edges.hpp"

namespace voxdag {

OddEdges find_odd_edges(const QuantizedMesh& mesh, MemoryBudget* memory, Progress* progress) {
  const std::size_t count = mesh.mesh_triangle_count();
  PageVector<std::uint64_t> hashes(memory);
  hashes.resize(3 * count);
  constexpr std::size_t kChunk = 4096;
  polled_for((count + kChunk - 1) / kChunk, 1, progress, "edges", [&](std::size_t chunk) {
    for (std::size_t i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i) {
      // 0 stands for an edge without length, which belongs to no surface.
      std::size_t place = 3 * i;
      each_edge(mesh, i, [&](Vec3i a, Vec3i b) { hashes[place++] = hash_of_edge(a, b) | 1; });
    }
  });
  polled_sort(hashes.begin(), hashes.end(), progress);
  OddEdges odd;
  std::uint64_t first_odd = 0;
  for (std::size_t i = 0; i < hashes.size();) {
    std::size_t end = i;
    while (end < hashes.size() && hashes[end] == hashes[i]) ++end;
    if (hashes[i] != 0 && (end - i) % 2 != 0 && odd.count++ == 0) first_odd = hashes[i];
    i = end;
  }
  for (std::size_t i = 0; i < count && odd.count > 0; ++i) {
    bool is_found = false;
    each_edge(mesh, i, [&](Vec3i a, Vec3i b) {
      if (is_found || (hash_of_edge(a, b) | 1) != first_odd) return;
      is_found = true;
      odd.a = a, odd.b = b;
    });
    if (is_found) break;
  }
  return odd;
}

}  // namespace voxdag
