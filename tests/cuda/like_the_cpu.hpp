#pragma once
/// Compares pictures of a device with the CPU's.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "voxdag/image/color.hpp"
#include "voxdag/render/render_options.hpp"

namespace voxdag {

inline int grey_level(float linear) {
  return static_cast<int>(linear_to_srgb(linear) * 255 + 0.5f);
}

/// Expects pictures and passes that differ by at most one grey level, and equal depths.
inline void expect_pixels_like(const RenderedImage& image, const RenderedImage& expected) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < expected.rgb.size(); ++i) {
    int apart = 0;
    for (int axis = 0; axis < 3; ++axis)
      apart = std::max(
          apart, std::abs(grey_level(image.rgb[i][axis]) - grey_level(expected.rgb[i][axis])));
    wrong += apart > 1 ? 1 : 0;
  }
  const auto expect_near = [](const std::vector<float>& values, const std::vector<float>& like) {
    ASSERT_EQ(values.size(), like.size());
    for (std::size_t i = 0; i < like.size(); ++i) EXPECT_NEAR(values[i], like[i], 1.0 / 255);
  };
  expect_near(image.occlusion, expected.occlusion);
  expect_near(image.shadow, expected.shadow);
  EXPECT_EQ(wrong, 0u) << "of " << expected.rgb.size() << " pixels";
  EXPECT_EQ(image.depth, expected.depth);
  EXPECT_EQ(image.albedo, expected.albedo);
  EXPECT_EQ(image.cells, expected.cells);
}

}  // namespace voxdag
