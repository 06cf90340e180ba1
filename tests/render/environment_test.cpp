// Compares environments with integrals over all directions.
#include "voxdag/render/environment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "support/error_of.hpp"

namespace voxdag {
namespace {

Vec3f smooth_light(Vec3f d) {
  return {1 + 0.5f * d.x - 0.3f * d.y, 0.6f + 0.2f * d.x * d.y + 0.3f * d.z * d.z,
          0.8f + 0.4f * d.z * d.x + 0.1f * (d.x * d.x - d.y * d.y)};
}

/// Returns smooth_light() as a picture.
ImageF smooth_picture(int height) {
  ImageF picture(2 * height, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < 2 * height; ++x) {
      const double down = (y + 0.5) / height * std::numbers::pi,
                   across = ((x + 0.5) / height - 1) * std::numbers::pi;
      const Vec3f light = smooth_light(static_cast<Vec3f>(Vec3d{
          std::sin(down) * std::sin(across), std::cos(down), -std::sin(down) * std::cos(across)}));
      for (int c = 0; c < 3; ++c) picture.pixel(x, y)[c] = light[c];
    }
  return picture;
}

Vec3f random_unit(std::mt19937& rng) {
  std::normal_distribution<float> normal;
  return normalized(Vec3f{normal(rng), normal(rng), normal(rng)});
}

TEST(Environment, APictureKeepsItsLightInEveryDirection) {
  std::mt19937 rng(1);
  const Environment environment(smooth_picture(256));
  const SkyMap map = environment.map({0, 1, 0});
  for (int i = 0; i < 1000; ++i) {
    const Vec3f d = random_unit(rng), light = map_radiance(map, d);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(light[c], smooth_light(d)[c], 0.01) << d.x << d.y << d.z;
  }
}

TEST(Environment, HarmonicsAreTheIrradianceOfSmoothLight) {
  // Smooth light has no parts beyond the nine harmonics.
  std::mt19937 rng(2);
  const Environment environment(128, smooth_light);
  const SkyMap map = environment.map({0, 1, 0});
  for (int i = 0; i < 5; ++i) {
    const Vec3f normal = random_unit(rng);
    Vec3d sum;
    constexpr int kSteps = 200;
    for (int row = 0; row < kSteps; ++row)
      for (int column = 0; column < 2 * kSteps; ++column) {
        const double down = (row + 0.5) / kSteps * std::numbers::pi,
                     across = (column + 0.5) / kSteps * std::numbers::pi;
        const auto d = static_cast<Vec3f>(Vec3d{std::sin(down) * std::cos(across), std::cos(down),
                                                std::sin(down) * std::sin(across)});
        const double weight = std::max(static_cast<double>(dot(d, normal)), 0.0) * std::sin(down);
        sum = sum + static_cast<Vec3d>(smooth_light(d)) *
                        (weight * std::numbers::pi * std::numbers::pi / kSteps / kSteps);
      }
    const Vec3f light = map_ambient(map, normal);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(static_cast<double>(light[c]), sum[c] / std::numbers::pi, 2e-3);
  }
}

TEST(Environment, ASmallSunBecomesALightAndLeavesTheSky) {
  const Vec3f towards = normalized(Vec3f{0.3f, 0.8f, -0.5f});
  const float cosine = std::cos(0.03f);
  const Environment environment(512, [&](Vec3f d) {
    return dot(d, towards) > cosine ? Vec3f{1000, 900, 800} : Vec3f{1, 1, 1};
  });
  const double angle = 2 * std::numbers::pi * (1 - static_cast<double>(cosine));
  EXPECT_GT(dot(environment.sun_direction(), towards), 0.9999f);
  // The sky keeps radiance of 20 times the mean there.
  EXPECT_NEAR(static_cast<double>(environment.sun_irradiance().x) / (1000 * angle), 1, 0.1);
  EXPECT_NEAR(environment.mean_luminance(), 1, 0.1);
}

TEST(Environment, ALargeBrightPartIsNoSun) {
  const Environment environment(64, [](Vec3f d) { return d.y > 0.5f ? Vec3f{9, 9, 9} : Vec3f{}; });
  EXPECT_EQ(environment.sun_irradiance().x, 0);
}

TEST(Environment, AnUpVectorAndATurnMoveThePicture) {
  const Environment environment(64, [](Vec3f d) {
    return d.z < -0.9f ? Vec3f{5, 5, 5} : Vec3f{1, 1, 1};
  });
  const auto is_bright = [&](Vec3f up, double degrees, Vec3f direction) {
    return map_radiance(environment.map(up, degrees), direction).x > 4;
  };
  EXPECT_TRUE(is_bright({0, 1, 0}, 0, {0, 0, -1}));
  EXPECT_TRUE(is_bright({0, 1, 0}, 90, {-1, 0, 0}));
  EXPECT_TRUE(is_bright({0, 0, 1}, 0, {0, 1, 0}));
  EXPECT_TRUE(is_bright({0, 0, 1}, 90, {-1, 0, 0}));
  EXPECT_FALSE(is_bright({0, 1, 0}, 90, {0, 0, -1}));
}

TEST(Environment, KeepsItsLightWhenItIsPacked) {
  std::mt19937 rng(3);
  const Vec3f towards = normalized(Vec3f{0.3f, 0.8f, -0.5f});
  const Environment environment(512, [&](Vec3f d) {
    return dot(d, towards) > 0.9995f ? Vec3f{1000, 900, 800} : smooth_light(d);
  });
  const Environment packed(environment.packed(128));
  EXPECT_EQ(packed.sun_irradiance(), environment.sun_irradiance());
  EXPECT_EQ(packed.sun_direction(), environment.sun_direction());
  EXPECT_NEAR(packed.mean_luminance() / environment.mean_luminance(), 1, 0.005);
  const SkyMap before = environment.map({0, 1, 0}), after = packed.map({0, 1, 0});
  EXPECT_EQ(after.side, 128);
  for (int i = 0; i < 1000; ++i) {
    const Vec3f d = random_unit(rng);
    const Vec3f ambient = map_ambient(before, d), again = map_ambient(after, d);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(again[c] / ambient[c], 1, 0.01);
      // Bytes round to 1/256 of the brightest colour. Texels at the sun's edge have a part of it.
      if (dot(d, towards) < 0.99f) {
        EXPECT_NEAR(map_radiance(after, d)[c], smooth_light(d)[c], 0.03);
      }
    }
  }
}

TEST(Environment, PacksEveryBrightness) {
  for (const float light : {1e-30f, 1e-3f, 0.998f, 255.9f, 65504.0f}) {
    const Environment environment(16, [&](Vec3f) { return Vec3f{light, light / 2, 0}; });
    const Environment packed(environment.packed(16));
    const Vec3f seen = map_radiance(packed.map({0, 1, 0}), {1, 0, 0});
    EXPECT_NEAR(seen.x / light, 1, 1.0 / 128);
    EXPECT_NEAR(seen.y / light, 0.5, 1.0 / 128);
    EXPECT_EQ(seen.z, 0);
  }
}

TEST(Environment, RefusesAPictureThatIsBlackOrNotOfAllDirections) {
  EXPECT_EQ(reason_of([] { const Environment environment(ImageF(30, 20, 3)); }),
            "an environment must be twice as wide as high (equirectangular), not 30 x 20");
  EXPECT_EQ(reason_of([] { const Environment environment(ImageF(40, 20, 3)); }),
            "the environment is black");
}

}  // namespace
}  // namespace voxdag
