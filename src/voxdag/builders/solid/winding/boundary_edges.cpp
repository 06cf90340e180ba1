#include "voxdag/builders/solid/winding/boundary_edges.hpp"

#include <algorithm>
#include <cstdlib>

#include "voxdag/builders/solid/mesh_edges.hpp"
#include "voxdag/core/parallel/polled_for.hpp"

namespace voxdag {
namespace {

/// The hash of an edge without its last bit.
std::uint64_t key_of(Vec3i a, Vec3i b) { return hash_of_edge(a, b) >> 1; }

/// An edge, and the number of triangles that run through it forwards, from its smaller end, less
/// those that run backwards.
struct Balance {
  std::uint64_t key = 0;
  std::int64_t forward = 0;
};

}  // namespace

CountedVector<BoundaryEdge> find_boundary_edges(const QuantizedMesh& mesh, Work work) {
  // The key of each edge, and in the last bit whether it runs backwards.
  PageVector<std::uint64_t> edges = sorted_edge_keys(
      mesh, work, [](Vec3i a, Vec3i b) { return key_of(a, b) << 1 | (is_before(a, b) ? 0u : 1u); });
  CountedVector<Balance> open(work.memory);
  for (std::size_t i = 0; i < edges.size() && edges[i] != kNoEdge;) {
    Balance balance{edges[i] >> 1, 0};
    for (; i < edges.size() && edges[i] >> 1 == balance.key; ++i)
      balance.forward += (edges[i] & 1) == 0 ? 1 : -1;
    if (balance.forward != 0) open.push_back(balance);
  }
  edges.release();

  CountedVector<BoundaryEdge> boundary(work.memory);
  boundary.reserve(open.size());
  for (std::size_t i = 0; i < mesh.mesh_triangle_count() && boundary.size() < open.size(); ++i) {
    work.poll_seldom(i);
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
