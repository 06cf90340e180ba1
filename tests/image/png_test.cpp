#include "voxdag/image/png.hpp"

#include <gtest/gtest.h>

#include "support/read_pictures.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

ImageRgb8 pattern(int width, int height) {
  ImageRgb8 image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c)
        image.pixel(x, y)[c] = static_cast<std::uint8_t>(x * 7 + y * 31 + c * 101);
  return image;
}

TEST(Png, PixelsSurviveTheRoundTrip) {
  const TempDir dir;
  const ImageRgb8 image = pattern(37, 19);
  write_png(dir / "a.png", image);
  EXPECT_EQ(read_rgb8(dir / "a.png"), image);
}

TEST(Png, NothingButTheFileIsLeftBehind) {
  const TempDir dir;
  write_png(dir / "a.png", pattern(4, 4));
  const std::filesystem::directory_iterator files(dir.path());
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

TEST(Png, TruncationAtEveryByteIsRefused) {
  const TempDir dir;
  write_png(dir / "a.png", pattern(9, 5));
  const std::string bytes = read_text(dir / "a.png");
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    write_text(dir / "cut.png", bytes.substr(0, n));
    EXPECT_THROW(read_rgb8(dir / "cut.png"), Error) << n << " of " << bytes.size();
  }
}

TEST(Png, AbsurdSizeInTheHeaderIsRefused) {
  const TempDir dir;
  // An IHDR of 999,999 x 999,999 with a correct checksum, an empty IDAT, and IEND.
  const unsigned char bytes[] = {
      0x89, 'P',  'N',  'G',  '\r', '\n', 0x1A, '\n', 0,    0,    0,    13,   'I',  'H',  'D',
      'R',  0x00, 0x0F, 0x42, 0x3F, 0x00, 0x0F, 0x42, 0x3F, 8,    2,    0,    0,    0,    0x2E,
      0x39, 0xCE, 0x2B, 0,    0,    0,    0,    'I',  'D',  'A',  'T',  0x35, 0xAF, 0x06, 0x1E,
      0,    0,    0,    0,    'I',  'E',  'N',  'D',  0xAE, 0x42, 0x60, 0x82};
  write_text(dir / "big.png", {reinterpret_cast<const char*>(bytes), sizeof bytes});
  try {
    read_rgb8(dir / "big.png");
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.reason(),
              "the image has 999999 x 999999 pixels; 1 to 268435456 are allowed, and at most "
              "1000000 a side");
  }
}

TEST(Png, ErrorsNameTheFile) {
  const TempDir dir;
  write_text(dir / "text.png", "hello, I am not a picture");
  for (const char* name : {"text.png", "missing.png"}) {
    try {
      read_rgb8(dir / name);
      FAIL() << name;
    } catch (const Error& e) {
      EXPECT_EQ(e.file(), (dir / name).string());
    }
  }
  EXPECT_THROW(write_png(dir / "no" / "such.png", pattern(2, 2)), Error);
  EXPECT_THROW(write_png(dir / "empty.png", ImageRgb8()), Error);
}

}  // namespace
}  // namespace voxdag
