#include "voxdag/solid/winding/boundary_edges.hpp"

#include <algorithm>
#include <cstdlib>

#include "voxdag/core/page_vector.hpp"
#include "voxdag/parallel/polled_for.hpp"
#include "voxdag/parallel/polled_sort.hpp"
#include "voxdag/solid/mesh_edges.hpp"

namespace voxdag {
namespace {

/// The hash of an edge without its last bit.
std::uint64_t key_of(Vec3i a, Vec3i b) { return hash_of_edge(a, b) >> 1; }

/// How often an edge occurs forwards, from its smaller end, less how often backwards.
struct Balance {
  std::uint64_t key = 0;
  std::int64_t forward = 0;
};

}  // namespace

CountedVector<BoundaryEdge> find_boundary_edges(const QuantizedMesh& mesh, MemoryBudget* memory,
                                                Progress* progress) {
  constexpr std::uint64_t kNoEdge = ~std::uint64_t{0};
  const std::size_t count = mesh.mesh_triangle_count();
  // The key of each edge, and in the last bit whether it runs backwards.
  PageVector<std::uint64_t> edges(memory);
  edges.resize(3 * count);
  constexpr std::size_t kChunk = 4096;
  polled_for((count + kChunk - 1) / kChunk, 1, progress, "edges", [&](std::size_t chunk) {
    for (std::size_t i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i) {
      std::fill_n(edges.begin() + 3 * i, 3, kNoEdge);
      std::size_t place = 3 * i;
      each_edge(mesh, i, [&](Vec3i a, Vec3i b) {
        edges[place++] = key_of(a, b) << 1 | (is_before(a, b) ? 0u : 1u);
      });
    }
  });
  polled_sort(edges.begin(), edges.end(), progress);

  CountedVector<Balance> open(memory);
  for (std::size_t i = 0; i < edges.size() && edges[i] != kNoEdge;) {
    Balance balance{edges[i] >> 1, 0};
    for (; i < edges.size() && edges[i] >> 1 == balance.key; ++i)
      balance.forward += (edges[i] & 1) == 0 ? 1 : -1;
    if (balance.forward != 0) open.push_back(balance);
  }
  edges.release();

  CountedVector<BoundaryEdge> boundary(memory);
  boundary.reserve(open.size());
  for (std::size_t i = 0; i < count && boundary.size() < open.size(); ++i) {
    poll_seldom(progress, i);
    each_edge(mesh, i, [&](Vec3i a, Vec3i b) {
      const std::uint64_t key = key_of(a, b);
      const auto found =
          std::lower_bound(open.begin(), open.end(), key,
                           [](const Balance& balance, std::uint64_t k) { return balance.key < k; });
      if (found == open.end() || found->key != key || found->forward == 0) return;
      if ((found->forward > 0) != is_before(a, b)) std::swap(a, b);
      boundary.push_back({a, b, static_cast<std::uint32_t>(std::abs(found->forward))});
      found->forward = 0;
    });
  }
  return boundary;
}

}  // namespace voxdag
