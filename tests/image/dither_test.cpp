#include "voxdag/image/dither.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace voxdag {
namespace {

TEST(Dither, TheMeanOverNeighboursIsTheExactValue) {
  constexpr int kSide = 8;
  for (const float value : {0.1f / 255, 100.25f / 255, 100.5f / 255, 254.9f / 255})
    for (const int corner : {0, 1000, 100'000}) {
      double sum = 0;
      for (int y = corner; y < corner + kSide; ++y)
        for (int x = corner; x < corner + kSide; ++x) {
          const int code = dithered_code(value, x, y);
          EXPECT_LE(std::fabs(static_cast<float>(code) - 255 * value), 1);
          sum += code;
        }
      EXPECT_NEAR(sum / (kSide * kSide), 255 * value, 0.05) << corner;
    }
}

TEST(Dither, OutOfRangeIsClampedAndNanIsBlack) {
  EXPECT_EQ(dithered_code(-1, 3, 4), 0);
  EXPECT_EQ(dithered_code(7, 3, 4), 255);
  EXPECT_EQ(dithered_code(std::numeric_limits<float>::quiet_NaN(), 3, 4), 0);
}

}  // namespace
}  // namespace voxdag
