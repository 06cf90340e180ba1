#include "voxdag/image/texture.hpp"

#include <gtest/gtest.h>

#include "voxdag/image/color.hpp"

namespace voxdag {
namespace {

DecodedImage image_of(int width, int height,
                      const std::vector<std::array<std::uint16_t, 4>>& pixels) {
  DecodedImage image(width, height, 4, 2, nullptr);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    image.set_pixel(static_cast<int>(i) % width, static_cast<int>(i) / width, pixels[i]);
  return image;
}

constexpr std::uint16_t kFull = 65535;

TEST(Texture, ColoursAverageInLinearLight) {
  const Texture texture =
      make_color_texture(image_of(2, 1, {{0, 0, 0, kFull}, {kFull, kFull, kFull, kFull}}), 0);
  const Texture::Value mean = texture.sample(1, {0.5f, 0.5f});
  EXPECT_NEAR(linear_to_srgb(mean[0] / 65535), 0.7354f, 1e-3f);  // not 0.5
}

TEST(Texture, MaskedTexelsDoNotBleed) {
  const DecodedImage image = image_of(2, 1, {{kFull, 0, 0, 40000}, {0, kFull, 0, 20000}});
  const Texture texture = make_color_texture(image, 0.5f);
  const Texture::Value mean = texture.sample(1, {0.5f, 0.5f});
  EXPECT_NEAR(mean[3], 32768, 1);    // half is visible
  EXPECT_NEAR(mean[0], mean[3], 1);  // and the visible part is red
  EXPECT_EQ(mean[1], 0);
  EXPECT_EQ(make_color_texture(image, 0).sample(1, {0, 0})[3], 65535);
}

TEST(Texture, AlphaAtTheThresholdIsVisible) {
  const DecodedImage image = image_of(2, 1, {{0, 0, 0, 128 * 257}, {0, 0, 0, 127 * 257}});
  const Texture texture = make_color_texture(image, 128.0f / 255);
  EXPECT_EQ(texture.sample(0, {0.25f, 0.5f})[3], 65535);
  EXPECT_EQ(texture.sample(0, {0.75f, 0.5f})[3], 0);
}

TEST(Texture, NormalsAreUnitAndTheirMeansShorter) {
  const DecodedImage image =
      image_of(2, 1, {{kFull, 32768, 32768, kFull}, {0, 32768, 32768, kFull}});
  const Texture texture = make_normal_texture(image, 1);
  EXPECT_NEAR(unpack_component(texture.sample(0, {0.25f, 0.5f})[0]), 1, 1e-3f);
  const Texture::Value mean = texture.sample(1, {0.5f, 0.5f});
  for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(unpack_component(mean[axis]), 0, 1e-3f);
}

TEST(Texture, NormalScaleFlattensOrSteepens) {
  const DecodedImage image = image_of(1, 1, {{49151, 32768, 65535, kFull}});  // x is 0.5, z is 1
  const Texture::Value flat = make_normal_texture(image, 0).sample(0, {0, 0});
  EXPECT_NEAR(unpack_component(flat[0]), 0, 1e-4f);
  const Texture::Value steep = make_normal_texture(image, 4).sample(0, {0, 0});
  EXPECT_NEAR(unpack_component(steep[0]) / unpack_component(steep[2]), 2, 1e-2f);
}

TEST(Texture, BumpsLeanAwayFromWhatIsHigh) {
  // If heights rise to the right, the normal leans to the left. If they rise to the lower edge, it
  // leans to the upper edge.
  DecodedImage right(8, 8, 4, 2, nullptr), down(8, 8, 4, 2, nullptr);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      const auto right_height = static_cast<std::uint16_t>(x * 8000);
      const auto down_height = static_cast<std::uint16_t>(y * 8000);
      right.set_pixel(x, y, {right_height, right_height, right_height, right_height});
      down.set_pixel(x, y, {down_height, down_height, down_height, down_height});
    }
  const TextureWraps clamp{TextureWrap::kClamp, TextureWrap::kClamp};
  const Texture::Value a = make_bump_texture(right, 1, clamp).sample(0, {0.5f, 0.5f});
  EXPECT_LT(unpack_component(a[0]), -0.005f);
  EXPECT_NEAR(unpack_component(a[1]), 0, 1e-4f);
  const Texture::Value b = make_bump_texture(down, 1, clamp).sample(0, {0.5f, 0.5f});
  EXPECT_GT(unpack_component(b[1]), 0.005f);
}

TEST(Texture, NormalMapsAreDistinguishedFromHeights) {
  EXPECT_TRUE(looks_like_normal_map(
      image_of(2, 1, {{33000, 32000, 65000, kFull}, {50000, 32768, 58000, kFull}})));
  EXPECT_FALSE(looks_like_normal_map(
      image_of(2, 1, {{33000, 33000, 33000, kFull}, {60000, 60000, 60000, kFull}})));
}

TEST(Texture, AnAlphaMapOfAnotherSizeIsStretched) {
  const DecodedImage color = image_of(1, 1, {{10, 20, 30, kFull}});
  DecodedImage grey(2, 1, 1, 1, nullptr);
  grey.row(0)[1] = 255;
  const DecodedImage both = with_alpha_of(color, grey);
  EXPECT_EQ(both.pixel(0, 0), (DecodedImage::Rgba{10, 20, 30, 0}));
  EXPECT_EQ(both.pixel(1, 0), (DecodedImage::Rgba{10, 20, 30, kFull}));
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
