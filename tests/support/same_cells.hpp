#pragma once
/// Compares the casts of layouts with the plain cast at the paper's layout, to the bit.
#include <gtest/gtest.h>

#include "support/brute_svdag.hpp"
#include "support/test_rays.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/stop_below_size.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {

/// The paper's layout, walked by the path of all layouts.
class PlainNodes : public SvdagNodes {
 public:
  using Path = NodePath<PlainNodes>;
  using SvdagNodes::SvdagNodes;
};

inline bool same(const CellHit& a, const CellHit& b) {
  return a.t == b.t && a.x == b.x && a.y == b.y && a.z == b.z && a.level == b.level;
}

/// Ends casts at voxels.
inline StopBelowSize no_size(int /*ray*/) { return {}; }

/// Returns a hook for ray `i` that ends casts at cells of a size that depends on i.
inline StopBelowSize some_size(int i) {
  StopBelowSize stop;
  stop.at_start = static_cast<float>(i % 17) * 0x1p-9f;
  stop.per_t = static_cast<float>(i % 29) * 0x1p-7f;
  stop.coarsest_level = 1 + i % 3;
  return stop;
}

/// Expects that casts at make_nodes(dag) find the same cells as those at PlainNodes, in several
/// sets of voxels. make_stop(i) returns the hook of ray i.
template <class MakeNodes, class MakeStop>
void expect_same_cells(int levels, unsigned seed, MakeNodes make_nodes, const MakeStop& make_stop) {
  Grid grid;
  grid.levels = levels;
  for (const NamedVoxels& set : voxel_sets(levels, seed)) {
    const Svdag dag = brute_svdag(levels, set.voxels);
    const PlainNodes plain(dag.view());
    const auto nodes = make_nodes(dag.view());
    TestRays rays(grid, seed);
    for (int i = 0; i < 400; ++i)
      for (int kind = 0; kind < static_cast<int>(RayKind::kCount); ++kind) {
        const GridRay ray = make_grid_ray(grid, rays.make(static_cast<RayKind>(kind)));
        const StopBelowSize stop = make_stop(i);
        CellHit expected, found;
        const bool is_hit = cast(plain, ray, stop, expected);
        ASSERT_EQ(cast(nodes, ray, stop, found), is_hit)
            << levels << " levels, " << set.name << ", kind " << kind << ", ray " << i;
        ASSERT_TRUE(!is_hit || same(found, expected))
            << levels << " levels, " << set.name << ", kind " << kind << ", ray " << i;
      }
  }
}

}  // namespace voxdag
