// Compares casts at a DAG with a dense grid above it with the paper's layout: both must find the
// same cell for every ray.
#include "voxdag/trace/top_cast.hpp"

#include <gtest/gtest.h>

#include "support/brute_svdag.hpp"
#include "support/same_cells.hpp"
#include "voxdag/trace/refill_caster.hpp"

namespace voxdag {
namespace {

/// Makes the grids of DAGs and owns the last one.
struct MakeTop {
  int levels_below = 2;  ///< Levels below the grid's; at least 2.
  TopGrid grid{};
  TopNodes operator()(const SvdagView& dag) {
    const int level = std::max(dag.levels - levels_below, 0);
    grid = {};
    if (level > 0) grid = make_top_grid(dag, level);
    return TopNodes(dag, grid.view());
  }
};

TEST(TopCast, MeetsWhatTheOctreeCastMeets) {
  for (const int levels : {2, 3, 4, 5, 6, 7})
    for (const int below : {2, 3}) expect_same_cells(levels, 11, MakeTop{below}, no_size);
}

TEST(TopCast, EndsAtTheSameLevelOfDetail) {
  for (const int levels : {3, 5, 6}) expect_same_cells(levels, 12, MakeTop{}, some_size);
}

TEST(RefillCaster, FindsWhatSingleRaysFind) {
  Grid grid;
  grid.levels = 5;
  for (const NamedVoxels& set : voxel_sets(grid.levels, 13)) {
    SCOPED_TRACE(set.name);
    const Svdag dag = brute_svdag(grid.levels, set.voxels);
    MakeTop make;
    const RefillCaster caster(make(dag.view()));
    TestRays test_rays(grid, 13);
    std::vector<CastRay> rays;
    for (int i = 0; i < 500; ++i)
      for (int kind = 0; kind < static_cast<int>(RayKind::kCount); ++kind)
        rays.push_back({make_grid_ray(grid, test_rays.make(static_cast<RayKind>(kind))),
                        i % 2 == 0 ? no_size(i) : some_size(i)});
    std::vector<int> results(rays.size(), -1);
    caster.any(
        static_cast<int>(rays.size()),
        [&](int i) -> const CastRay& { return rays[static_cast<std::size_t>(i)]; },
        [&](int i, bool is_hit) { results[static_cast<std::size_t>(i)] = is_hit ? 1 : 0; });
    for (std::size_t i = 0; i < rays.size(); ++i) {
      CellHit cell;
      ASSERT_EQ(results[i], cast(SvdagNodes(dag.view()), rays[i].ray, rays[i].stop, cell) ? 1 : 0)
          << "ray " << i;
    }
  }
}

/// Returns the free way of a cell by definition.
int brute_free_way(const std::vector<bool>& is_set, int side, Vec3i cell, int octant) {
  for (int size = 1; size <= side; ++size)
    for (int i = 0; i < size * size * size; ++i) {
      const Vec3i step{i % size, i / size % size, i / size / size};
      Vec3i at = cell;
      bool is_inside = true;
      for (int axis = 0; axis < 3; ++axis) {
        at[axis] += (octant >> axis & 1) != 0 ? step[axis] : -step[axis];
        is_inside = is_inside && at[axis] >= 0 && at[axis] < side;
      }
      if (is_inside && is_set[static_cast<std::size_t>(at.x + side * (at.y + side * at.z))])
        return size - 1;
    }
  return 255;
}

TEST(TopGrid, HoldsTheNodesAndTheLargestEmptyCubes) {
  constexpr int kLevel = 3, kSide = 1 << kLevel;
  const std::vector<Vec3i> voxels{{0, 0, 0}, {21, 6, 9}, {22, 6, 8}, {31, 31, 31}, {30, 4, 12}};
  const Svdag dag = brute_svdag(5, voxels);
  const TopGrid grid = make_top_grid(dag.view(), kLevel);
  std::vector<bool> is_set(kSide * kSide * kSide);
  for (const Vec3i& v : voxels)
    is_set[static_cast<std::size_t>(v.x / 4 + kSide * (v.y / 4 + kSide * (v.z / 4)))] = true;
  for (std::size_t i = 0; i < is_set.size(); ++i) {
    const std::uint64_t cell = grid.cells[i];
    ASSERT_EQ(TopGridView::is_empty(cell), !is_set[i]);
    const auto n = static_cast<int>(i);
    const Vec3i at{n % kSide, n / kSide % kSide, n / kSide / kSide};
    if (!is_set[i]) {
      for (int octant = 0; octant < 8; ++octant) {
        // A cube that reaches the end of the grid in all directions is free for ever.
        const int expected = brute_free_way(is_set, kSide, at, octant);
        ASSERT_EQ(TopGridView::free_way(cell, static_cast<std::uint32_t>(octant)), expected)
            << at.x << " " << at.y << " " << at.z << " octant " << octant;
      }
      continue;
    }
    std::uint64_t block = 0;
    for (const Vec3i& v : voxels)
      if (v.x / 4 == at.x && v.y / 4 == at.y && v.z / 4 == at.z)
        block |= std::uint64_t{1} << (leaf_bits(v.x % 4, 0) | leaf_bits(v.y % 4, 1) |
                                      leaf_bits(v.z % 4, 2));
    EXPECT_EQ(dag.leaf_blocks[TopGridView::node(cell)], block);
  }
}

}  // namespace
}  // namespace voxdag
