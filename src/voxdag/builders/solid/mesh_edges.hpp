#pragma once
/// The edges of a mesh on the grid's integers.
#include <algorithm>
#include <cstdint>
#include <utility>

#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/page_vector.hpp"
#include "voxdag/core/parallel/polled_sort.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {

/// Returns 64 bits of an edge, whatever its direction. Different edges have equal bits with a
/// probability of 2^-64.
inline std::uint64_t hash_of_edge(Vec3i a, Vec3i b) {
  if (is_before(b, a)) std::swap(a, b);
  std::uint64_t h = 0x9E3779B97F4A7C15ull;
  for (const std::int32_t part : {a.x, a.y, a.z, b.x, b.y, b.z}) {
    h = (h ^ static_cast<std::uint32_t>(part)) * 0xD6E8FEB86659FD93ull;
    h ^= h >> 32;
  }
  return h;
}

/// Calls visit(a, b) for the edges of a triangle that have a length. Triangles out of range have
/// none.
template <class Visit>
void each_edge(const QuantizedMesh& mesh, std::size_t triangle, const Visit& visit) {
  if (!mesh.in_range(triangle)) return;
  const QuantizedTriangle t = mesh.triangle(triangle);
  for (int corner = 0; corner < 3; ++corner) {
    const Vec3i a = t[corner], b = t[(corner + 1) % 3];
    if (a != b) visit(a, b);
  }
}

/// A key that sorts after the keys of all edges.
inline constexpr std::uint64_t kNoEdge = ~std::uint64_t{0};

/// Returns key_of(a, b) for all edges of the mesh's triangles in ascending order. Edges without a
/// length have kNoEdge. Takes 24 bytes per triangle in `work`. Throws OverMemory and Cancelled.
template <class KeyOf>
PageVector<std::uint64_t> sorted_edge_keys(const QuantizedMesh& mesh, Work work,
                                           const KeyOf& key_of) {
  const std::size_t count = mesh.mesh_triangle_count();
  PageVector<std::uint64_t> keys(work.memory);
  keys.resize(3 * count);
  constexpr std::size_t kChunk = 4096;
  polled_for((count + kChunk - 1) / kChunk, 1, work, "edges", [&](std::size_t chunk) {
    for (std::size_t i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i) {
      std::fill_n(keys.begin() + 3 * i, 3, kNoEdge);
      std::size_t place = 3 * i;
      each_edge(mesh, i, [&](Vec3i a, Vec3i b) { keys[place++] = key_of(a, b); });
    }
  });
  polled_sort(keys.begin(), keys.end(), work);
  return keys;
}

}  // namespace voxdag
