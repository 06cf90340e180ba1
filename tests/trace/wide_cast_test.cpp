// Compares the wide layout with the paper's: both must find the same cell for every ray.
#include "voxdag/trace/wide_cast.hpp"

#include <gtest/gtest.h>

#include "support/brute_svdag.hpp"
#include "support/test_rays.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/trace/stop_below_size.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {
namespace {

bool same(const CellHit& a, const CellHit& b) {
  return a.t == b.t && a.x == b.x && a.y == b.y && a.z == b.z && a.level == b.level;
}

template <class MakeStop>
void expect_same_cells(int levels, unsigned seed, const MakeStop& make_stop) {
  Grid grid;
  grid.levels = levels;
  for (const NamedVoxels& set : voxel_sets(levels, seed)) {
    const Svdag dag = brute_svdag(levels, set.voxels);
    const WideSvdag wide = make_wide_svdag(dag.view());
    const SvdagNodes nodes(dag.view());
    const WideNodes wide_nodes(wide.view());
    TestRays rays(grid, seed);
    for (int i = 0; i < 400; ++i)
      for (int kind = 0; kind < static_cast<int>(RayKind::kCount); ++kind) {
        const GridRay ray = make_grid_ray(grid, rays.make(static_cast<RayKind>(kind)));
        const StopBelowSize stop = make_stop(i);
        CellHit expected, found;
        const bool is_hit = cast(nodes, ray, stop, expected);
        ASSERT_EQ(cast(wide_nodes, ray, stop, found), is_hit)
            << levels << " levels, " << set.name << ", kind " << kind << ", ray " << i;
        ASSERT_TRUE(!is_hit || same(found, expected))
            << levels << " levels, " << set.name << ", kind " << kind << ", ray " << i;
      }
  }
}

TEST(WideCast, MeetsWhatTheOctreeCastMeets) {
  for (const int levels : {2, 3, 4, 5, 6, 7})
    expect_same_cells(levels, 11, [](int) { return StopBelowSize{}; });
}

TEST(WideCast, EndsAtTheSameLevelOfDetail) {
  for (const int levels : {3, 5, 6})
    expect_same_cells(levels, 12, [](int i) {
      StopBelowSize stop;
      stop.at_start = static_cast<float>(i % 17) * 0x1p-9f;
      stop.per_t = static_cast<float>(i % 29) * 0x1p-7f;
      stop.coarsest_level = 1 + i % 3;
      return stop;
    });
}

TEST(WideSvdag, HoldsEveryVoxelOnce) {
  const std::vector<Vec3i> voxels{{0, 0, 0}, {5, 1, 2}, {7, 7, 7}};
  const Svdag dag = brute_svdag(4, voxels);
  const WideSvdag wide = make_wide_svdag(dag.view());
  const WideNodes nodes(wide.view());
  EXPECT_EQ(wide.view().levels, 4);
  EXPECT_EQ(nodes.mask(nodes.root()), 1u | 1u << 1 | 1u << (1 + 4 + 16));
  const auto first = nodes.child(nodes.root(), nodes.mask(nodes.root()), 0);
  EXPECT_EQ(nodes.mask(first), 1u);
  const auto second = nodes.child(nodes.root(), nodes.mask(nodes.root()), 1);
  EXPECT_EQ(nodes.mask(second), std::uint64_t{1} << (1 + 4 * 1 + 16 * 2));
}

}  // namespace
}  // namespace voxdag
