#include "voxdag/image/exr.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "support/error_of.hpp"
#include "support/read_pictures.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/image/light_image.hpp"

namespace voxdag {
namespace {

ImageF pattern() {
  ImageF image(13, 7, 4);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = static_cast<float>(i) * 0.37f - 20.0f;
  image.pixel(3, 2)[0] = std::numeric_limits<float>::infinity();
  return image;
}

const std::vector<std::string> kNames = {"N.X", "N.Y", "N.Z",
                                         "Z"};  // sorted, as OpenEXR returns them

TEST(Exr, ChannelsSurviveTheRoundTripBitForBit) {
  const TempDir dir;
  write_exr(dir / "a.exr", pattern(), kNames);
  const ExrImage back = read_exr(dir / "a.exr");
  EXPECT_EQ(back.channel_names, kNames);
  EXPECT_EQ(back.image, pattern());
}

TEST(Exr, ChannelsComeBackSortedWithTheirValues) {
  const TempDir dir;
  ImageF image(1, 1, 2);
  image.pixels = {1.0f, 2.0f};
  write_exr(dir / "a.exr", image, {"Z", "A"});
  const ExrImage back = read_exr(dir / "a.exr");
  EXPECT_EQ(back.channel_names, (std::vector<std::string>{"A", "Z"}));
  EXPECT_EQ(back.image.pixels, (std::vector<float>{2.0f, 1.0f}));
}

TEST(Exr, BadNamesAndEmptyImagesAreRefused) {
  const TempDir dir;
  EXPECT_THROW(write_exr(dir / "a.exr", pattern(), {"A", "B", "C"}), Error);
  EXPECT_THROW(write_exr(dir / "a.exr", pattern(), {"A", "B", "C", "A"}), Error);
  EXPECT_THROW(write_exr(dir / "a.exr", ImageF(), {}), Error);
  EXPECT_FALSE(std::filesystem::exists(dir / "a.exr"));
}

TEST(LightImage, AnExrComesBackWithoutNegativeAndInfiniteLight) {
  const TempDir dir;
  ImageF image(4, 2, 3), expected(4, 2, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = expected.pixels[i] = static_cast<float>(i) * 3.7f;
  image.pixels[5] = -0.25f;
  expected.pixels[5] = 0;
  image.pixels[7] = std::numeric_limits<float>::infinity();
  expected.pixels[7] = 65504;
  write_exr(dir / "a.exr", image, {"R", "G", "B"});
  EXPECT_EQ(read_light_image(dir / "a.exr"), expected);
  ImageF grey(4, 2, 1);
  grey.pixels = {1, 2, 3, 4, 5, 6, 7, 8};
  write_exr(dir / "y.exr", grey, {"Y"});
  EXPECT_EQ(read_light_image(dir / "y.exr").pixel(1, 1)[2], 6);
  write_exr(dir / "z.exr", grey, {"Z"});
  EXPECT_EQ(reason_of([&] { read_light_image(dir / "z.exr"); }),
            "the EXR has neither the channels R, G and B nor Y");
}

TEST(LightImage, ARadianceFileComesBack) {
  const TempDir dir;
  // Two pixels: mantissas 128, 64, 32 with the exponents 0 and 3.
  const std::string pixels = "\x80\x40\x20\x80\x80\x40\x20\x83";
  const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n";
  std::ofstream(dir / "a.hdr", std::ios::binary) << header << pixels;
  EXPECT_EQ(read_light_image(dir / "a.hdr").pixels,
            (std::vector<float>{0.5f, 0.25f, 0.125f, 4, 2, 1}));
  std::ofstream(dir / "b.hdr", std::ios::binary)
      << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4096 +X 8192\n";
  EXPECT_EQ(reason_of([&] { read_light_image(dir / "b.hdr"); }), "the HDR image is truncated");
}

}  // namespace
}  // namespace voxdag
