#pragma once
/// The grid of the test pictures, and a comparison of two pictures.
#include <gtest/gtest.h>

#include "voxdag/core/grid.hpp"
#include "voxdag/render/render_options.hpp"

namespace voxdag::test {

/// The levels of the test pictures' grid.
inline constexpr int kPictureLevels = 6;

/// Returns the grid of 64³ voxels over [-1,1]³.
inline Grid picture_grid() {
  Grid grid;
  grid.levels = kPictureLevels;
  grid.origin = {-1, -1, -1};
  grid.voxel_size = 2.0 / 64;
  return grid;
}

/// Expects two pictures to be equal to the bit, except the number of rays.
inline void expect_same_picture(const RenderedImage& image, const RenderedImage& expected) {
  EXPECT_EQ(image.rgb, expected.rgb);
  EXPECT_EQ(image.radiance, expected.radiance);
  EXPECT_EQ(image.depth, expected.depth);
  EXPECT_EQ(image.normal, expected.normal);
  EXPECT_EQ(image.occlusion, expected.occlusion);
  EXPECT_EQ(image.shadow, expected.shadow);
  EXPECT_EQ(image.albedo, expected.albedo);
  EXPECT_EQ(image.cells, expected.cells);
}

}  // namespace voxdag::test
