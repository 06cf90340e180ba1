#include "voxdag/algebra/reorient.hpp"

#include <gtest/gtest.h>

#include "voxel_grid.hpp"

namespace voxdag {
namespace {

TEST(Reorient, MakesTheVoxelsOfAll48Symmetries) {
  constexpr int kAxes[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (const int levels : {2, 4}) {
    const std::vector<Vec3i> voxels = random_voxels(levels, 60, 3);
    const VoxelGrid grid(levels, voxels);
    const Svdag dag = brute_svdag(levels, voxels);
    for (const auto& axes : kAxes)
      for (int flips = 0; flips < 8; ++flips) {
        Orientation orientation;
        for (int axis = 0; axis < 3; ++axis) {
          orientation.source_axis[axis] = axes[axis];
          orientation.is_flipped[axis] = (flips >> axis & 1) != 0;
        }
        ASSERT_EQ(reorient(dag.view(), orientation), VoxelGrid::dag_of(levels, [&](Vec3i v) {
                    std::int32_t from[3];
                    for (int axis = 0; axis < 3; ++axis)
                      from[axes[axis]] =
                          orientation.is_flipped[axis] ? (1 << levels) - 1 - v[axis] : v[axis];
                    return grid.contains({from[0], from[1], from[2]});
                  }));
      }
  }
}

TEST(Reorient, AQuarterTurnAboutAnAxisTakesTheNextAxisToTheOneAfterIt) {
  const auto turned = [](Vec3i voxel, int axis, int turns) {
    return reorient(brute_svdag(4, {voxel}).view(), rotated(axis, turns));
  };
  EXPECT_EQ(turned({9, 0, 2}, 2, 1), brute_svdag(4, {{15, 9, 2}}));  // x to y, y to -x
  EXPECT_EQ(turned({2, 9, 0}, 0, 1), brute_svdag(4, {{2, 15, 9}}));
  EXPECT_EQ(turned({0, 2, 9}, 1, 1), brute_svdag(4, {{9, 2, 15}}));
  EXPECT_EQ(turned({9, 0, 2}, 2, -1), brute_svdag(4, {{0, 6, 2}}));
  EXPECT_EQ(turned({9, 0, 2}, 2, 6), brute_svdag(4, {{6, 15, 2}}));
  EXPECT_EQ(reorient(brute_svdag(4, {{9, 0, 2}}).view(), mirrored(0)), brute_svdag(4, {{6, 0, 2}}));
}

TEST(Reorient, OrientationsFollowEachOther) {
  const Svdag dag = brute_svdag(5, random_voxels(5, 300, 8));
  const Orientation first = then(rotated(0, 1), mirrored(1)), second = rotated(2, 3);
  EXPECT_EQ(reorient(reorient(dag.view(), first).view(), second),
            reorient(dag.view(), then(first, second)));
  EXPECT_EQ(rotated(1, 4), Orientation{});
  EXPECT_EQ(then(mirrored(2), mirrored(2)), Orientation{});
}

}  // namespace
}  // namespace voxdag
