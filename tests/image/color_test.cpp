#include "voxdag/image/color.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace voxdag {
namespace {

TEST(Color, KnownPointsOfTheTransferFunction) {
  EXPECT_EQ(srgb_to_linear(0.0f), 0.0f);
  EXPECT_EQ(srgb_to_linear(1.0f), 1.0f);
  EXPECT_NEAR(srgb_to_linear(0.5f), 0.21404114f, 1e-6f);  // the standard's formula in 64 bits
  EXPECT_NEAR(linear_to_srgb(0.18f), 0.46135613f, 1e-6f);
}

TEST(Color, EveryCodeSurvivesTheRoundTrip) {
  for (int code = 0; code < 256; ++code)
    EXPECT_EQ(linear_to_srgb8(srgb8_to_linear(static_cast<std::uint8_t>(code))), code);
}

TEST(Color, OutOfRangeIsClampedAndNanIsBlack) {
  EXPECT_EQ(linear_to_srgb8(-1.0f), 0);
  EXPECT_EQ(linear_to_srgb8(7.0f), 255);
  EXPECT_EQ(linear_to_srgb8(std::numeric_limits<float>::quiet_NaN()), 0);
}

}  // namespace
}  // namespace voxdag
