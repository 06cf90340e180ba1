#pragma once
/// The edges of a mesh on the grid's integers.
#include <cstdint>
#include <utility>

#include "voxdag/core/vec_order.hpp"
#include "voxdag/voxelize/grid_mapping.hpp"

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

}  // namespace voxdag
