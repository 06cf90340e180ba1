#include "lab/attributes/ms_ssim.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace voxdag::lab {
namespace {

/// A pattern of integers, and the pattern with noise of integers.
struct Pair {
  GreyImage a, b;
};
Pair patterns(int width, int height, int k) {
  Pair pair{{width, height, {}}, {width, height, {}}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int v = (x * x * 3 + y * 7 + x * y) % 97 + (x / 8 + y / 8) % 2 * 100;
      const int noise = (x * 31 + y * 17 + x * y * k) % 23 - 11;
      pair.a.values.push_back(v);
      pair.b.values.push_back(std::clamp(v + noise, 0, 255));
    }
  return pair;
}

// The expected values are from a program in another language, which computes each window's
// variances directly, in two passes over its 121 pixels.
TEST(MsSsim, IsThatOfADirectProgram) {
  const Pair square = patterns(176, 176, 1), odd = patterns(201, 181, 3);
  EXPECT_NEAR(ms_ssim(square.a, square.b), 0.998393945074, 1e-9);
  EXPECT_NEAR(ms_ssim(odd.a, odd.b), 0.998756589469, 1e-9);
}

TEST(MsSsim, EqualPicturesHaveOne) {
  const Pair pair = patterns(180, 176, 2);
  EXPECT_NEAR(ms_ssim(pair.a, pair.a), 1, 1e-12);
}

// Only luminance differs, which counts at the coarsest scale alone, with the exponent 0.1333.
TEST(MsSsim, OfFlatPicturesIsTheirLuminance) {
  const std::size_t pixels = std::size_t{176} * 176;
  const GreyImage a{176, 176, std::vector<double>(pixels, 100)},
      b{176, 176, std::vector<double>(pixels, 150)};
  constexpr double kC1 = 2.55 * 2.55;
  const double luminance = (2 * 100 * 150 + kC1) / (100 * 100 + 150 * 150 + kC1);
  EXPECT_NEAR(ms_ssim(a, b), std::pow(luminance, 0.1333), 1e-9);
}

TEST(MsSsim, APictureAndItsNegativeHaveZero) {
  Pair pair = patterns(176, 176, 1);
  for (std::size_t i = 0; i < pair.a.values.size(); ++i) pair.b.values[i] = 255 - pair.a.values[i];
  EXPECT_EQ(ms_ssim(pair.a, pair.b), 0);
}

}  // namespace
}  // namespace voxdag::lab
