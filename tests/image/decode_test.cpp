#include "voxdag/image/decode.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "support/temp_dir.hpp"
#include "support/test_png.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/image/jpeg.hpp"
#include "voxdag/image/png.hpp"

namespace voxdag {
namespace {

std::vector<std::uint16_t> ramp(std::size_t count, unsigned step) {
  std::vector<std::uint16_t> samples;
  for (std::size_t i = 0; i < count; ++i)
    samples.push_back(static_cast<std::uint16_t>(i * step + 3));
  return samples;
}

/// Returns all pixels as four values of 16 bits.
std::vector<std::uint16_t> pixels_of(const DecodedImage& image) {
  std::vector<std::uint16_t> pixels;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      for (const std::uint16_t value : image.pixel(x, y)) pixels.push_back(value);
  return pixels;
}

TEST(DecodeImage, SixteenBitsAndAlphaAreKept) {
  const TempDir dir;
  for (const bool interlaced : {false, true}) {
    const auto samples = ramp(7 * 5 * 4, 997);
    write_test_png(dir / "a.png", 7, 5, 4, 16, samples, interlaced);
    const DecodedImage image = read_image(dir / "a.png");
    EXPECT_EQ(image.width(), 7);
    EXPECT_EQ(image.height(), 5);
    EXPECT_TRUE(image.has_alpha());
    EXPECT_EQ(pixels_of(image), samples);
  }
}

TEST(DecodeImage, EightBitsAreSpreadOverSixteen) {
  const TempDir dir;
  write_test_png(dir / "a.png", 2, 1, 4, 8, {0, 1, 128, 7, 255, 254, 2, 0});
  const DecodedImage image = read_image(dir / "a.png");
  EXPECT_EQ(image.bytes(), 8u);
  EXPECT_EQ(pixels_of(image),
            (std::vector<std::uint16_t>{0, 257, 128 * 257, 7 * 257, 65535, 254 * 257, 514, 0}));
}

TEST(DecodeImage, GreyBecomesThreeChannelsAndAlphaIsFullWhereThereIsNone) {
  const TempDir dir;
  write_test_png(dir / "a.png", 2, 1, 1, 16, {1000, 50000});
  const DecodedImage image = read_image(dir / "a.png");
  EXPECT_FALSE(image.has_alpha());
  EXPECT_EQ(image.bytes(), 4u);
  EXPECT_EQ(pixels_of(image),
            (std::vector<std::uint16_t>{1000, 1000, 1000, 65535, 50000, 50000, 50000, 65535}));
}

TEST(DecodeImage, TruncationAtEveryByteIsRefused) {
  const TempDir dir;
  write_test_png(dir / "a.png", 9, 5, 2, 16, ramp(90, 601));
  const std::string bytes = read_text(dir / "a.png");
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    const std::vector<std::uint8_t> cut(bytes.begin(),
                                        bytes.begin() + static_cast<std::ptrdiff_t>(n));
    EXPECT_THROW(decode_image(cut, "cut"), Error) << n << " of " << bytes.size();
  }
}

TEST(DecodeImage, DamagedFilesAreRefusedOrReadButNeverCrash) {
  const TempDir dir;
  write_test_png(dir / "a.png", 9, 5, 4, 8, ramp(180, 1));
  const std::string bytes = read_text(dir / "a.png");
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    std::vector<std::uint8_t> damaged(bytes.begin(), bytes.end());
    damaged[n] ^= 0x55;
    try {
      EXPECT_FALSE(decode_image(damaged, "damaged").is_empty());
    } catch (const Error& error) {
      EXPECT_EQ(error.file(), "damaged");
    }
  }
}

TEST(DecodeImage, OnlyRegularFilesAreReadAndPipesAreNotWaitedFor) {
  const TempDir dir;
  ASSERT_EQ(::mkfifo((dir / "pipe.png").c_str(), 0600), 0);
  for (const auto& [path, reason] :
       {std::pair(dir / "pipe.png", "is not a regular file"), {dir.path(), "is a directory"}}) {
    try {
      read_image(path);
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.reason(), reason);
    }
  }
}

TEST(DecodeImage, OtherFormatsAreRefusedByName) {
  const TempDir dir;
  write_text(dir / "a.tga", "no picture");
  try {
    read_image(dir / "a.tga");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), (dir / "a.tga").string());
    EXPECT_EQ(error.reason(), "neither a PNG nor a JPEG image");
  }
}

}  // namespace
}  // namespace voxdag
