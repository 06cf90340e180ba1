#include "voxdag/esvo/open_edges.hpp"

#include <tbb/parallel_sort.h>

#include "voxdag/parallel/parallel_for.hpp"

namespace voxdag {
namespace {

/// Equal for equal edges, whatever their direction; two others may by chance share one, which
/// makes an open edge look closed.
std::uint64_t edge_key(Vec3i a, Vec3i b) {
  const auto point_key = [](Vec3i p) {
    std::uint64_t key = 0x9E3779B97F4A7C15ull;
    for (int axis = 0; axis < 3; ++axis) {
      key ^= static_cast<std::uint32_t>(p[axis]);
      key *= 0xFF51AFD7ED558CCDull;
      key ^= key >> 33;
    }
    return key;
  };
  const std::uint64_t sum = point_key(a) + point_key(b);
  return (sum ^ sum >> 29) * 0xC4CEB9FE1A85EC53ull;
}

}  // namespace

std::vector<std::uint8_t> find_open_edges(const QuantizedMesh& mesh) {
  const std::size_t count = mesh.triangle_count();
  std::vector<std::uint64_t> keys(3 * count);
  const auto key_of = [&](std::size_t triangle, int e) {
    const QuantizedTriangle t = mesh.triangle(triangle);
    return edge_key(t[e], t[(e + 1) % 3]);
  };
  parallel_for(count, 1024, [&](std::size_t i) {
    if (!mesh.in_range(i)) return;
    for (int e = 0; e < 3; ++e) keys[3 * i + static_cast<std::size_t>(e)] = key_of(i, e);
  });
  tbb::parallel_sort(keys.begin(), keys.end());
  std::vector<std::uint8_t> open(count);
  parallel_for(count, 1024, [&](std::size_t i) {
    if (!mesh.in_range(i) || mesh.source(i) != i) return;
    for (int e = 0; e < 3; ++e) {
      const auto same = std::equal_range(keys.begin(), keys.end(), key_of(i, e));
      if (same.second - same.first == 1) open[i] |= static_cast<std::uint8_t>(1u << e);
    }
  });
  return open;
}

}  // namespace voxdag
