#include "voxdag/algebra/shift.hpp"

#include <gtest/gtest.h>

#include "voxel_grid.hpp"

namespace voxdag {
namespace {

TEST(Shift, MovesEveryVoxelAndDropsThoseThatLeaveTheGrid) {
  std::mt19937 rng(9);
  for (const int levels : {2, 3, 4, 5}) {
    const std::int32_t n = 1 << levels;
    const auto offset = [&] {
      return static_cast<std::int32_t>(rng() % static_cast<unsigned>(2 * n + 3)) - n - 1;
    };
    for (const NamedVoxels& set : voxel_sets(levels, 1)) {
      const VoxelGrid grid(levels, set.voxels);
      const Svdag dag = brute_svdag(levels, set.voxels);
      for (int i = 0; i < 12; ++i) {
        const Vec3i by = i == 0 ? Vec3i{0, 0, 0} : Vec3i{offset(), offset(), offset()};
        const int other = std::max(2, levels - 1 + i % 4);
        ASSERT_EQ(shift(dag.view(), by, other),
                  VoxelGrid::dag_of(other, [&](Vec3i v) { return grid.contains(v - by); }))
            << set.name << " by " << by.x << " " << by.y << " " << by.z << ", " << levels
            << " levels";
      }
    }
  }
}

TEST(Shift, ComesBackAtTheLargestGrids) {
  const Svdag dag = brute_svdag(kMaxLevels, {{1, 2, 3}, {77777, 5, 123456}});
  const Vec3i by{400'001, 300'003, 1};
  const Svdag moved = shift(dag.view(), by, kMaxLevels);
  EXPECT_EQ(moved, brute_svdag(kMaxLevels, {{400'002, 300'005, 4}, {477'778, 300'008, 123'457}}));
  EXPECT_EQ(shift(moved.view(), {-by.x, -by.y, -by.z}, kMaxLevels), dag);
  EXPECT_TRUE(shift(dag.view(), {1 << 30, 0, 0}, kMaxLevels).view().is_empty());
}

}  // namespace
}  // namespace voxdag
