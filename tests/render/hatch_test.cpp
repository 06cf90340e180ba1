#include "voxdag/render/hatch.hpp"

#include <gtest/gtest.h>

namespace voxdag {
namespace {

TEST(Hatch, ThePeriodIsThePowerOfTwoNextToItsPartOfTheView) {
  EXPECT_EQ(hatch_period(kHatchPeriods), 1);
  EXPECT_EQ(hatch_period(kHatchPeriods * 1.4), 1);
  EXPECT_EQ(hatch_period(kHatchPeriods * 1.5), 2);
  EXPECT_EQ(hatch_period(kHatchPeriods / 64), 1.0f / 64);
}

TEST(Hatch, TheNamedPartOfACutFaceIsDark) {
  constexpr int kSteps = 1000;
  for (const Vec3f normal : {Vec3f{1, 0, 0}, Vec3f{0, -1, 0}, Vec3f{0.1f, 0.2f, 0.9f}}) {
    int dark = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double at = (i + 0.5) / kSteps;
      dark += is_hatched({at, at * 2, at * 3}, normal, 0.25f) ? 1 : 0;
    }
    EXPECT_NEAR(dark, kHatchWidth * kSteps, 12);  // 12 to 20 lines, each half a step off.
  }
}

TEST(Hatch, LinesKeepTheirPlaceInTheWorld) {
  // The view does not enter: a place is dark or not, whatever side of the face one sees.
  for (int i = 0; i < 500; ++i) {
    const Vec3d place{i * 0.01, 0.3, i * 0.003};
    if (!is_hatched(place, {0, 1, 0}, 0.5f)) continue;
    EXPECT_EQ(is_hatched(place, {0, 1, 0}, 0.5f), is_hatched(place, {0, -1, 0}, 0.5f));
    const double height = (place.x + place.z) / 0.5;
    EXPECT_LT(height - std::floor(height), static_cast<double>(kHatchWidth));
  }
}

}  // namespace
}  // namespace voxdag
