#include "voxdag/render/tone_map.hpp"

#include <gtest/gtest.h>

#include "voxdag/render/exposure.hpp"

namespace voxdag {
namespace {

constexpr ToneMap kAll[] = {ToneMap::kNeutral, ToneMap::kAgx, ToneMap::kFilmic};

Vec3f grey(float x) { return {x, x, x}; }

TEST(ToneMap, EveryCurveRisesFromBlackToWhiteAndStaysInRange) {
  for (const ToneMap kind : kAll) {
    EXPECT_NEAR(tone_map(kind, grey(0)).y, 0, 1e-6f);
    EXPECT_GT(tone_map(kind, grey(1e6f)).y, 0.98f);
    float before = 0;
    for (float x = 0.001f; x < 1e4f; x *= 1.1f) {
      const Vec3f rgb = tone_map(kind, grey(x));
      EXPECT_GE(rgb.y, before) << x;
      EXPECT_LE(rgb.y, 1) << x;
      // The matrices of AgX keep grey to a quarter of a step of 8 bits.
      EXPECT_NEAR(rgb.x, rgb.y, 1e-3f);
      EXPECT_NEAR(rgb.z, rgb.y, 1e-3f);
      before = rgb.y;
    }
  }
}

TEST(ToneMap, NeutralOnlyDarkensColoursThatAreNotBright) {
  for (const auto& [rgb, peak] :
       {std::pair{Vec3f{0.7f, 0.3f, 0.1f}, 0.66f}, {Vec3f{0.02f, 0.01f, 0.005f}, 0.0025f}}) {
    const Vec3f mapped = tone_map(ToneMap::kNeutral, rgb);
    EXPECT_FLOAT_EQ(mapped.x, peak);
    EXPECT_FLOAT_EQ(mapped.y, peak * rgb.y / rgb.x);
    EXPECT_FLOAT_EQ(mapped.z, peak * rgb.z / rgb.x);
  }
  EXPECT_FLOAT_EQ(tone_map(ToneMap::kNeutral, grey(static_cast<float>(ExposureRule::kMiddle))).x,
                  0.18f);
}

TEST(ToneMap, NeutralKeepsTheHueOfBrightColoursAndFilmicDoesNot) {
  // The middle channel of a hue lies at the same part of the way from the least to the greatest.
  const auto middle = [](Vec3f rgb) { return (rgb.y - rgb.z) / (rgb.x - rgb.z); };
  const Vec3f orange{4, 2, 0};
  EXPECT_NEAR(middle(tone_map(ToneMap::kNeutral, orange)), 0.5f, 1e-5f);
  EXPECT_GT(middle(tone_map(ToneMap::kFilmic, orange)), 0.9f);
}

TEST(ToneMap, AgxShowsMiddleGreyAsMiddleGrey) {
  EXPECT_NEAR(tone_map(ToneMap::kAgx, grey(0.18f)).y, 0.18f, 0.05f);
}

}  // namespace
}  // namespace voxdag
