#pragma once
/// What tests of pictures share: the grid that they show, and when two of them are the same.
#include <gtest/gtest.h>

#include "voxdag/core/grid.hpp"
#include "voxdag/render/render_options.hpp"

namespace voxdag::test {

/// [-1,1]³ in 64³ voxels.
inline constexpr int kPictureLevels = 6;

inline Grid picture_grid() {
  Grid grid;
  grid.levels = kPictureLevels;
  grid.origin = {-1, -1, -1};
  grid.voxel_size = 2.0 / 64;
  return grid;
}

/// To the bit, but for the number of rays.
inline void expect_same_picture(const RenderedImage& image, const RenderedImage& expected) {
  EXPECT_EQ(image.rgb, expected.rgb);
  EXPECT_EQ(image.radiance, expected.radiance);
  EXPECT_EQ(image.depth, expected.depth);
  EXPECT_EQ(image.normal, expected.normal);
  EXPECT_EQ(image.occlusion, expected.occlusion);
  EXPECT_EQ(image.shadow, expected.shadow);
}

}  // namespace voxdag::test
