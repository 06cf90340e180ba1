#include "voxdag/core/angles.hpp"

#include <gtest/gtest.h>

#include <random>

#include "voxdag/core/io/checksum.hpp"

namespace voxdag {
namespace {

TEST(Angles, ArcTangentsAreThoseOfTheLibrary) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> exponent(-20, 20);
  for (int i = 0; i < 100'000; ++i) {
    const double y = std::exp(exponent(rng)) * (rng() % 2 ? 1 : -1),
                 x = std::exp(exponent(rng)) * (rng() % 2 ? 1 : -1);
    ASSERT_NEAR(arc_tangent(y, x), std::atan2(y, x), 1e-15) << y << " " << x;
  }
  for (const double y : {-1.0, 0.0, 1.0})
    for (const double x : {-1.0, 0.0, 1.0}) EXPECT_NEAR(arc_tangent(y, x), std::atan2(y, x), 1e-15);
}

TEST(Angles, SinesAndCosinesAreThoseOfTheLibrary) {
  std::mt19937 rng(2);
  std::uniform_real_distribution<double> angles(-1000, 1000);
  for (int i = 0; i < 100'000; ++i) {
    const double angle = i % 2 != 0 ? angles(rng) : angles(rng) / 300;
    const auto [sine, cosine] = sine_and_cosine(angle);
    ASSERT_NEAR(sine, std::sin(angle), 3e-16) << angle;
    ASSERT_NEAR(cosine, std::cos(angle), 3e-16) << angle;
    ASSERT_NEAR(arc_cosine(std::cos(angle)), std::acos(std::cos(angle)), 1e-15) << angle;
  }
  EXPECT_EQ(cosine_of(0), 1);
  EXPECT_EQ(sine_and_cosine(0).sine, 0);
  EXPECT_LE(std::abs(cosine_of(1e300)), 1);
}

// The digests were made on x86-64; no processor and no compiler may change a bit.
TEST(Angles, HaveTheSameBitsOnEveryMachine) {
  std::vector<double> values;
  for (int degrees = -720; degrees <= 720; ++degrees) {
    const auto [sine, cosine] = sine_and_cosine(degrees * std::numbers::pi / 180);
    values.insert(values.end(), {sine, cosine, arc_cosine(cosine), arc_tangent(sine, cosine)});
  }
  EXPECT_EQ(xxh3_64(std::as_bytes(std::span(values))), 0xfa57b9718677c6bd);
}

}  // namespace
}  // namespace voxdag
