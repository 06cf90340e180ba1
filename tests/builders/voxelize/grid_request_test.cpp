#include "voxdag/builders/voxelize/grid_request.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/error_of.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"

namespace voxdag {
namespace {

const Box3d kBounds{{1, 2, 3}, {9, 6, 5}};  // 8 units along x

/// Returns the voxel of a vertex.
Vec3i voxel_of(const Grid& grid, Vec3d vertex) {
  const Vec3i units = quantize(grid, vertex).value();
  return {units.x >> 8, units.y >> 8, units.z >> 8};
}

TEST(GridRequest, AnyResolutionSpansTheLongestSide) {
  for (const std::int64_t n : {1, 2, 3, 5, 10, 100, 1000, 1023, 1025, 1 << 20}) {
    const Grid grid = grid_for(kBounds, {.resolution = n});
    EXPECT_EQ(voxel_of(grid, kBounds.lo), (Vec3i{0, 0, 0})) << n;
    EXPECT_EQ(voxel_of(grid, kBounds.hi).x, n - 1) << n;
    EXPECT_GE(grid.resolution(), n);
    EXPECT_LT(grid.resolution(), std::max<std::int64_t>(2 * n, 5)) << n;
  }
}

TEST(GridRequest, PowersOfTwoAreTheGridsOfTheirLevels) {
  for (int levels = kMinLevels; levels <= kMaxLevels; ++levels) {
    const std::int64_t n = std::int64_t{1} << levels;
    EXPECT_EQ(grid_for(kBounds, {.resolution = n}), fit_grid(kBounds, levels));
    EXPECT_EQ(grid_for(Box3d::empty(), {.resolution = n, .bounds = kBounds}),
              grid_from_bounds(kBounds, levels));
  }
  EXPECT_EQ(settings_of({.resolution = 64}).count("resolution"), 0u);
  EXPECT_EQ(settings_of({.resolution = 65}).at("resolution"), "65");
}

TEST(GridRequest, BoundsAreDividedExactly) {
  const Grid grid =
      grid_for(Box3d::empty(), {.resolution = 10, .bounds = Box3d{{0, 0, 0}, {5, 1, 1}}});
  EXPECT_EQ(grid.voxel_size, 0.5);
  EXPECT_EQ(grid.quantization_scale, 512);
  EXPECT_EQ(grid.levels, 4);
}

TEST(GridRequest, SnappedGridsOfOneVoxelSizeHaveTheirVoxelsAtTheSamePlaces) {
  const Vec3d kLow{10.3, -20.7, 5.2};
  for (const double size : {1.0, 0.1, 0.3, 0.05, 7.0}) {
    const Grid a =
        grid_for(Box3d{{10.3, -20.7, 5.2}, {11, 0, 6}}, {.voxel_size = size, .snap = true});
    for (int axis = 0; axis < 3; ++axis) {
      const double at = a.origin[axis] / size;
      EXPECT_NEAR(at, std::round(at), 1e-9) << size;
      EXPECT_LE(a.origin[axis], kLow[axis] + 1e-9);
      EXPECT_GT(a.origin[axis] + size, kLow[axis] - 1e-9);
    }
  }
  // A multiple in decimals stays one: 0.3 / 0.1 is below 3 in doubles.
  EXPECT_EQ(grid_for(Box3d{{0.3, 0.6, 0.7}, {1, 1, 1}}, {.voxel_size = 0.1, .snap = true}).origin,
            (Vec3d{3 * 0.1, 6 * 0.1, 7 * 0.1}));
}

TEST(GridRequest, TheOriginIsTheLowerCornerAndTheGridEndsWithTheMesh) {
  const Grid grid = grid_for(kBounds, {.voxel_size = 1, .origin = Vec3d{-3, 0, 0}});
  EXPECT_EQ(grid.origin, (Vec3d{-3, 0, 0}));
  EXPECT_EQ(grid.levels, 4);  // 13 voxels along x
  const Grid divided = grid_for(kBounds, {.resolution = 12, .origin = Vec3d{-3, 0, 0}});
  EXPECT_EQ(voxel_of(divided, kBounds.hi).x, 11);
  EXPECT_NE(error_of([] { grid_for(kBounds, {.voxel_size = 1, .origin = Vec3d{10, 0, 0}}); }), "");
}

TEST(GridRequest, PaddingLeavesEmptyVoxelsOnEachSide) {
  const Grid grid = grid_for(kBounds, {.resolution = 16, .padding = 3});
  EXPECT_EQ(grid.levels, 4);
  EXPECT_EQ(voxel_of(grid, kBounds.lo), (Vec3i{3, 3, 3}));
  EXPECT_EQ(voxel_of(grid, kBounds.hi).x, 12);
  const Grid sized = grid_for(kBounds, {.voxel_size = 1, .padding = 4});
  EXPECT_EQ(sized.origin, (Vec3d{-3, -2, -1}));
  EXPECT_EQ(sized.levels, 5);  // 9 voxels and 8 empty ones
  EXPECT_NE(error_of([] { grid_for(kBounds, {.resolution = 6, .padding = 3}); }), "");
}

TEST(GridRequest, TheCentredContentHasAsMuchRoomOnBothSides) {
  const Grid grid = grid_for(kBounds, {.resolution = 10, .center = true});
  const Vec3i first = voxel_of(grid, kBounds.lo), last = voxel_of(grid, kBounds.hi);
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t above = grid.resolution() - 1 - last[axis];
    EXPECT_GE(above - first[axis], 0);
    EXPECT_LE(above - first[axis], 1);
  }
  const Grid snapped = grid_for(kBounds, {.voxel_size = 0.7, .snap = true, .center = true});
  EXPECT_NEAR(std::remainder(snapped.origin.y, 0.7), 0, 1e-9);
}

}  // namespace
}  // namespace voxdag
