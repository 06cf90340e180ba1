#include "voxdag/image/decode.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <webp/encode.h>

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

std::vector<std::uint8_t> joined(std::initializer_list<int> header,
                                 std::initializer_list<int> pixels) {
  std::vector<std::uint8_t> bytes;
  for (const auto& part : {header, pixels})
    for (const int byte : part) bytes.push_back(static_cast<std::uint8_t>(byte));
  return bytes;
}

/// Expects that the first n bytes are refused if n is less than `needed`.
void expect_truncations_are_refused(const std::vector<std::uint8_t>& bytes, std::size_t needed) {
  for (std::size_t n = 0; n < needed; ++n) {
    const std::vector<std::uint8_t> cut(bytes.begin(),
                                        bytes.begin() + static_cast<std::ptrdiff_t>(n));
    EXPECT_THROW(decode_image(cut, "cut"), Error) << n << " of " << bytes.size();
  }
}

/// Red, green, blue and white, from the lower left.
const std::vector<std::uint16_t> kFourColors = {0,     0, 65535, 65535, 65535, 65535, 65535, 65535,
                                                65535, 0, 0,     65535, 0,     65535, 0,     65535};

TEST(DecodeImage, TgaPlainAndWithRuns) {
  const std::initializer_list<int> plain = {0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 2, 0, 24, 0};
  const auto bytes = joined(plain, {0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255});
  EXPECT_EQ(pixels_of(decode_image(bytes, "a.tga")), kFourColors);
  expect_truncations_are_refused(bytes, bytes.size());
  const auto mirrored =  // Bit 4: the pixels of a row run from right to left.
      joined({0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 2, 0, 24, 0x10},
             {0, 255, 0, 0, 0, 255, 255, 255, 255, 255, 0, 0});
  EXPECT_EQ(pixels_of(decode_image(mirrored, "a.tga")), kFourColors);
  const std::initializer_list<int> runs = {0, 0, 10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 2, 0, 32, 8};
  const auto packed = joined(runs, {1, 0, 0, 255, 255, 0, 255, 0, 9, 129, 1, 2, 3, 4});
  const DecodedImage image = decode_image(packed, "a.tga");
  EXPECT_TRUE(image.has_alpha());
  EXPECT_EQ(image.pixel(1, 1), (DecodedImage::Rgba{0, 65535, 0, 9 * 257}));
  EXPECT_EQ(image.pixel(1, 0), (DecodedImage::Rgba{3 * 257, 2 * 257, 257, 4 * 257}));
  expect_truncations_are_refused(packed, packed.size());
}

TEST(DecodeImage, BmpOf24Bits) {
  auto bytes = joined({'B', 'M'}, {70, 0, 0, 0, 0, 0, 0, 0, 54, 0, 0, 0, 40, 0,
                                   0,  0, 2, 0, 0, 0, 2, 0, 0,  0, 1, 0, 24});
  bytes.resize(54);
  const auto pixels = joined({0, 0, 255, 0, 255, 0, 0, 0}, {255, 0, 0, 255, 255, 255});
  bytes.insert(bytes.end(), pixels.begin(), pixels.end());
  EXPECT_EQ(pixels_of(decode_image(bytes, "a.bmp")), kFourColors);
  expect_truncations_are_refused(bytes, bytes.size());
}

TEST(DecodeImage, WebpWithAlpha) {
  const std::uint8_t rgba[] = {1, 2, 3, 255, 40, 50, 60, 128};
  std::uint8_t* encoded = nullptr;
  const std::size_t size = WebPEncodeLosslessRGBA(rgba, 2, 1, 8, &encoded);
  const std::vector<std::uint8_t> bytes(encoded, encoded + size);
  WebPFree(encoded);
  const DecodedImage image = decode_image(bytes, "a.webp");
  EXPECT_EQ(image.pixel(0, 0), (DecodedImage::Rgba{257, 2 * 257, 3 * 257, 65535}));
  EXPECT_EQ(image.pixel(1, 0)[3], 128 * 257);
  expect_truncations_are_refused(bytes, bytes.size() - 1);  // The last byte only pads.
}

TEST(DecodeImage, ManyPixelsInFewBytesCountBeforeTheyAreDecoded) {
  std::vector<std::uint8_t> tga(18, 0);
  tga[2] = 10;
  tga[12] = tga[14] = 0xFF;
  tga[13] = tga[15] = 0x3F;  // 16,383 x 16,383 pixels
  tga[16] = 24;
  for (int i = 0; i < 16383 * 128; ++i) tga.insert(tga.end(), {255, 1, 2, 3});
  MemoryBudget memory(100 << 20);
  EXPECT_THROW(decode_image(tga, "a.tga", {&memory, {}}), OverMemory);
  EXPECT_EQ(memory.used(), 0u);
}

TEST(DecodeImage, OtherFormatsAreRefusedByName) {
  const TempDir dir;
  const auto refused = [&](const std::string& bytes) {
    write_text(dir / "a.tga", bytes);
    try {
      read_image(dir / "a.tga");
      return std::string("read");
    } catch (const Error& error) {
      EXPECT_EQ(error.file(), (dir / "a.tga").string());
      return error.reason();
    }
  };
  EXPECT_EQ(refused("no picture"), "not an image: PNG, JPEG, WebP, BMP and TGA images are read");
  EXPECT_EQ(refused("GIF89a..."), "a GIF image: PNG, JPEG, WebP, BMP and TGA images are read");
}

}  // namespace
}  // namespace voxdag
