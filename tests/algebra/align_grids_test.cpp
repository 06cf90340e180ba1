#include "voxdag/algebra/align_grids.hpp"

#include <gtest/gtest.h>

#include "support/error_of.hpp"

namespace voxdag {
namespace {

Grid grid(int levels, Vec3d origin, double voxel_size) {
  Grid result;
  result.levels = levels;
  result.origin = origin;
  result.voxel_size = voxel_size;
  return result;
}

TEST(AlignGrids, TheFirstGridIsKeptIfItHoldsTheSecond) {
  const Grid first = grid(8, {1, 2, 3}, 0.1), second = grid(5, {2, 2.5, 3}, 0.1);
  const AlignedGrids aligned = align_grids(first, second);
  EXPECT_EQ(aligned.grid, first);
  EXPECT_EQ(aligned.first, (Vec3i{0, 0, 0}));
  EXPECT_EQ(aligned.second, (Vec3i{10, 5, 0}));
}

TEST(AlignGrids, ACommonGridHoldsBoth) {
  const AlignedGrids aligned = align_grids(grid(4, {0, 0, 0}, 0.5), grid(5, {-1, 4, 20}, 0.5));
  EXPECT_EQ(aligned.first, (Vec3i{2, 0, 0}));
  EXPECT_EQ(aligned.second, (Vec3i{0, 8, 40}));
  EXPECT_EQ(aligned.grid.levels, 7);  // 40 + 32 voxels along z
  EXPECT_EQ(aligned.grid.origin, (Vec3d{-1, 0, 0}));
  EXPECT_EQ(aligned.grid.voxel_size, 0.5);
}

TEST(AlignGrids, GridsThatDoNotAlignAreRefusedWithTheReason) {
  const Grid first = grid(10, {0, 0, 0}, 0.25);
  const auto refusal = [&](const Grid& second) {
    return error_of([&] { align_grids(first, second); });
  };
  EXPECT_EQ(refusal(grid(10, {0, 0, 0}, 0.5)),
            "the grids do not align: their voxels have sides of 0.25 and 0.5");
  EXPECT_EQ(refusal(grid(10, {0, 0, 0}, 0.25001)),
            "the grids do not align: their voxels have sides of 0.25 and 0.25001");
  EXPECT_EQ(refusal(grid(10, {0, 0.125 / 2, 0}, 0.25)),
            "the grids do not align: along y they are a part of a voxel apart, 0.25");
  EXPECT_EQ(refusal(grid(10, {300'000, 0, 0}, 0.25)),
            "the grids are too far apart: a grid that holds both would have more than 1048576 "
            "voxels a side");
  EXPECT_EQ(refusal(grid(10, {1e300, 0, 0}, 0.25)),
            "the grids do not align: they are too far apart for a common grid");
}

}  // namespace
}  // namespace voxdag
