#include "voxdag/edit/place_stamp.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "support/brute_svdag.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/algebra/reorient.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/stored/svdag/for_each_voxel.hpp"

namespace voxdag {
namespace {

/// Two voxels whose box is (3,5,7) to (6,7,8), in a grid of voxels of side 1/2 at (1,2,3).
const std::vector<Vec3i> kVoxels = {{3, 5, 7}, {5, 6, 7}};
Grid stamp_grid() { return {.levels = 4, .origin = {1, 2, 3}, .voxel_size = 0.5}; }
Grid target_grid() { return {.levels = 5, .origin = {0, 0, 0}, .voxel_size = 0.5}; }

std::vector<Vec3i> placed(const StampPlace& place, Box3i* box = nullptr) {
  const Svdag stamp = brute_svdag(4, kVoxels);
  const PlacedStamp result = place_stamp(stamp.view(), stamp_grid(), place, target_grid());
  EXPECT_EQ(result.voxels.levels, 5);
  if (box != nullptr) *box = result.box;
  std::vector<Vec3i> voxels;
  for_each_voxel(result.voxels.view(), whole_grid(5), [&](Vec3i v) { voxels.push_back(v); });
  return voxels;
}

TEST(PlaceStamp, VoxelsStayInTheirPlaceByDefault) {
  Box3i box;
  EXPECT_EQ(placed({}, &box), (std::vector<Vec3i>{{5, 9, 13}, {7, 10, 13}}));
  EXPECT_EQ(box, (Box3i{{5, 9, 13}, {8, 11, 14}}));
}

TEST(PlaceStamp, TheLowerCornerComesToThePlaceAndRoundsToVoxels) {
  EXPECT_EQ(placed({.at = Vec3d{0.2, 2.3, 1}}), (std::vector<Vec3i>{{0, 5, 2}, {2, 6, 2}}));
  // Voxels outside of the grid are left out.
  EXPECT_EQ(placed({.at = Vec3d{-1, 0, 0}}), (std::vector<Vec3i>{{0, 1, 0}}));
  EXPECT_TRUE(placed({.at = Vec3d{-100, 0, 0}}).empty());
}

TEST(PlaceStamp, OrientationsTurnTheStampBeforeItIsPlaced) {
  const Vec3d origin{0, 0, 0};
  EXPECT_EQ(placed({mirrored(0), origin}), (std::vector<Vec3i>{{0, 1, 0}, {2, 0, 0}}));
  // A quarter turn about z takes x to y: (0,0) and (2,1) become (1,0) and (0,2).
  EXPECT_EQ(placed({rotated(2, 1), origin}), (std::vector<Vec3i>{{1, 0, 0}, {0, 2, 0}}));
}

TEST(PlaceStamp, OtherVoxelSizesAndFarPlacesAreErrors) {
  const Svdag stamp = brute_svdag(4, kVoxels);
  Grid grid = stamp_grid();
  grid.voxel_size = 0.6;
  EXPECT_THROW(place_stamp(stamp.view(), grid, {}, target_grid()), Error);
  EXPECT_THROW(placed({.at = Vec3d{1e12, 0, 0}}), Error);
  EXPECT_THROW(placed({.at = Vec3d{std::nan(""), 0, 0}}), Error);
}

}  // namespace
}  // namespace voxdag
