#include "voxdag/algebra/crop.hpp"

#include <gtest/gtest.h>

#include "voxel_grid.hpp"

namespace voxdag {
namespace {

bool contains(const Box3i& box, Vec3i v) {
  for (int axis = 0; axis < 3; ++axis)
    if (v[axis] < box.lo[axis] || v[axis] >= box.hi[axis]) return false;
  return true;
}

TEST(Crop, KeepsTheVoxelsInTheBox) {
  std::mt19937 rng(5);
  for (const int levels : {2, 3, 5}) {
    const std::int32_t n = 1 << levels;
    const auto coordinate = [&] {
      return static_cast<std::int32_t>(rng() % static_cast<unsigned>(n + 5)) - 2;
    };
    const auto corner = [&] { return Vec3i{coordinate(), coordinate(), coordinate()}; };
    for (const NamedVoxels& set : voxel_sets(levels, 7)) {
      const VoxelGrid grid(levels, set.voxels);
      const Svdag dag = brute_svdag(levels, set.voxels);
      for (int i = 0; i < 20; ++i) {
        const Vec3i a = corner(), b = corner();
        const Box3i box{min(a, b), max(a, b)};
        ASSERT_EQ(crop(dag.view(), box),
                  VoxelGrid::dag_of(levels,
                                    [&](Vec3i v) { return grid.contains(v) && contains(box, v); }))
            << set.name << ", " << levels << " levels";
      }
    }
  }
}

TEST(Crop, BoxesThatContainTheGridKeepAllAndEmptyOnesNothing) {
  const Svdag dag = brute_svdag(5, random_voxels(5, 500, 2));
  EXPECT_EQ(crop(dag.view(), {{0, 0, 0}, {32, 32, 32}}), dag);
  EXPECT_EQ(crop(dag.view(), {{-2147483647, -7, -1}, {2147483647, 32, 99}}), dag);
  EXPECT_TRUE(crop(dag.view(), {{3, 4, 5}, {3, 32, 32}}).view().is_empty());
  EXPECT_TRUE(crop(dag.view(), {{9, 9, 9}, {5, 32, 32}}).view().is_empty());
  EXPECT_TRUE(crop(dag.view(), {{40, 0, 0}, {50, 32, 32}}).view().is_empty());
}

}  // namespace
}  // namespace voxdag
