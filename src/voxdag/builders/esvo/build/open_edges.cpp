#include "voxdag/builders/esvo/build/open_edges.hpp"

#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/core/parallel/polled_sort.hpp"

namespace voxdag {
namespace {

/// Returns a hash of an edge that does not depend on its direction. If the upper halves of the
/// hashes of two different edges collide, an open edge may count as closed.
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

std::vector<std::uint8_t> find_open_edges(const QuantizedMesh& mesh, const IndexSet& ignored,
                                          Work work) {
  const std::size_t count = mesh.triangle_count();
  const auto counts = [&](std::size_t i) {
    return mesh.in_range(i) && !ignored.contains(mesh.source(i));
  };
  // The upper half of an edge's key and its number, 3 * triangle + edge. Triangles that do not
  // count get equal keys for all edges, so none of their edges is open.
  CountedVector<std::uint64_t> edges(3 * count, work.memory);
  polled_for(count, 4096, work, "edges", [&](std::size_t i) {
    const QuantizedTriangle t = counts(i) ? mesh.triangle(i) : QuantizedTriangle{};
    for (int e = 0; e < 3; ++e) {
      const std::size_t edge = 3 * i + static_cast<std::size_t>(e);
      edges[edge] = (edge_key(t[e], t[(e + 1) % 3]) & ~std::uint64_t{0xFFFFFFFF}) | edge;
    }
  });
  const auto report = [&](double fraction) {
    work.poll();
    work.report("open edges", fraction, count);
  };
  polled_sort(edges.begin(), edges.end(), work);
  std::vector<std::uint8_t> open(count);
  const auto is_same = [&](std::size_t i, std::size_t j) {
    return edges[i] >> 32 == edges[j] >> 32;
  };
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i % (1 << 20) == 0) report(static_cast<double>(i) / static_cast<double>(edges.size()));
    if ((i > 0 && is_same(i, i - 1)) || (i + 1 < edges.size() && is_same(i, i + 1))) continue;
    const std::size_t edge = edges[i] & 0xFFFFFFFF, triangle = edge / 3;
    if (counts(triangle) && mesh.source(triangle) == triangle)
      open[triangle] |= static_cast<std::uint8_t>(1u << edge % 3);
  }
  return open;
}

}  // namespace voxdag
