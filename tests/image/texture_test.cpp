#include "voxdag/image/texture.hpp"

#include <gtest/gtest.h>

#include "voxdag/image/color.hpp"
#include "voxdag/image/srgb_curve.hpp"

namespace voxdag {
namespace {

ImageRgba16 image_of(int width, int height,
                     const std::vector<std::array<std::uint16_t, 4>>& pixels) {
  ImageRgba16 image(width, height);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    std::copy(pixels[i].begin(), pixels[i].end(), image.pixels.begin() + 4 * static_cast<long>(i));
  return image;
}

constexpr std::uint16_t kFull = 65535;

TEST(Texture, ColoursAverageInLinearLight) {
  const Texture texture =
      make_color_texture(image_of(2, 1, {{0, 0, 0, kFull}, {kFull, kFull, kFull, kFull}}), 0);
  const Texture::Value mean = texture.sample(1, {0.5f, 0.5f});
  EXPECT_NEAR(linear_to_srgb(mean[0] / 65535), 0.7354f, 1e-3f);  // not 0.5
}

TEST(Texture, WhatIsCutAwayDoesNotBleed) {
  const ImageRgba16 image = image_of(2, 1, {{kFull, 0, 0, 40000}, {0, kFull, 0, 20000}});
  const Texture texture = make_color_texture(image, 0.5f);
  const Texture::Value mean = texture.sample(1, {0.5f, 0.5f});
  EXPECT_NEAR(mean[3], 32768, 1);    // half is visible
  EXPECT_NEAR(mean[0], mean[3], 1);  // and that is red
  EXPECT_EQ(mean[1], 0);
  EXPECT_EQ(make_color_texture(image, 0).sample(1, {0, 0})[3], 65535);
}

TEST(Texture, AlphaAtTheThresholdIsVisible) {
  const ImageRgba16 image = image_of(2, 1, {{0, 0, 0, 128 * 257}, {0, 0, 0, 127 * 257}});
  const Texture texture = make_color_texture(image, 128.0f / 255);
  EXPECT_EQ(texture.sample(0, {0.25f, 0.5f})[3], 65535);
  EXPECT_EQ(texture.sample(0, {0.75f, 0.5f})[3], 0);
}

TEST(Texture, NormalsAreUnitAndTheirMeansShorter) {
  const ImageRgba16 image =
      image_of(2, 1, {{kFull, 32768, 32768, kFull}, {0, 32768, 32768, kFull}});
  const Texture texture = make_normal_texture(image, 1);
  EXPECT_NEAR(unpack_component(texture.sample(0, {0.25f, 0.5f})[0]), 1, 1e-3f);
  const Texture::Value mean = texture.sample(1, {0.5f, 0.5f});
  for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(unpack_component(mean[axis]), 0, 1e-3f);
}

TEST(Texture, NormalScaleFlattensOrSteepens) {
  const ImageRgba16 image = image_of(1, 1, {{49151, 32768, 65535, kFull}});  // x 0.5, z 1
  const Texture::Value flat = make_normal_texture(image, 0).sample(0, {0, 0});
  EXPECT_NEAR(unpack_component(flat[0]), 0, 1e-4f);
  const Texture::Value steep = make_normal_texture(image, 4).sample(0, {0, 0});
  EXPECT_NEAR(unpack_component(steep[0]) / unpack_component(steep[2]), 2, 1e-2f);
}

TEST(Texture, BumpsLeanAwayFromWhatIsHigh) {
  // A ramp up to the right: the normal leans to the left; up to the lower edge: to the upper.
  ImageRgba16 right(8, 8), down(8, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      for (int c = 0; c < 4; ++c) {
        right.pixel(x, y)[c] = static_cast<std::uint16_t>(x * 8000);
        down.pixel(x, y)[c] = static_cast<std::uint16_t>(y * 8000);
      }
  const TextureWraps clamp{TextureWrap::kClamp, TextureWrap::kClamp};
  const Texture::Value a = make_bump_texture(right, 1, clamp).sample(0, {0.5f, 0.5f});
  EXPECT_LT(unpack_component(a[0]), -0.005f);
  EXPECT_NEAR(unpack_component(a[1]), 0, 1e-4f);
  const Texture::Value b = make_bump_texture(down, 1, clamp).sample(0, {0.5f, 0.5f});
  EXPECT_GT(unpack_component(b[1]), 0.005f);
}

TEST(Texture, NormalMapsAreToldFromHeights) {
  EXPECT_TRUE(looks_like_normal_map(
      image_of(2, 1, {{33000, 32000, 65000, kFull}, {50000, 32768, 58000, kFull}})));
  EXPECT_FALSE(looks_like_normal_map(
      image_of(2, 1, {{33000, 33000, 33000, kFull}, {60000, 60000, 60000, kFull}})));
}

TEST(Texture, AnAlphaMapOfAnotherSizeIsStretched) {
  const ImageRgba16 color = image_of(1, 1, {{10, 20, 30, kFull}});
  const ImageRgba16 grey = image_of(2, 1, {{0, 0, 0, kFull}, {kFull, kFull, kFull, kFull}});
  const ImageRgba16 both = with_alpha_of(color, grey);
  EXPECT_EQ(both.pixels, (std::vector<std::uint16_t>{10, 20, 30, 0, 10, 20, 30, kFull}));
}

TEST(SrgbCurve, TheTableIsTheCurve) {
  float last = 0;
  for (int i = 0; i <= 100000; ++i) {
    const float linear = static_cast<float>(i) / 100000;
    EXPECT_NEAR(linear_to_srgb_fast(linear), linear_to_srgb(linear), 1e-5f);
    EXPECT_GE(linear_to_srgb_fast(linear), last);
    last = linear_to_srgb_fast(linear);
  }
}

}  // namespace
}  // namespace voxdag
