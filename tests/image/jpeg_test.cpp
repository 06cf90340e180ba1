#include "voxdag/image/jpeg.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
// jpeglib.h needs <cstdio> before it.
#include <jpeglib.h>

#include "support/read_pictures.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

ImageRgb8 smooth(int width, int height) {
  ImageRgb8 image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      image.pixel(x, y)[0] = static_cast<std::uint8_t>(x * 3);
      image.pixel(x, y)[1] = static_cast<std::uint8_t>(y * 5);
      image.pixel(x, y)[2] = 128;
    }
  return image;
}

std::string encode(const ImageRgb8& image) {
  jpeg_compress_struct info{};
  jpeg_error_mgr errors;
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&info, &bytes, &size);
  info.image_width = static_cast<JDIMENSION>(image.width);
  info.image_height = static_cast<JDIMENSION>(image.height);
  info.input_components = 3;
  info.in_color_space = JCS_RGB;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, 98, TRUE);
  jpeg_start_compress(&info, TRUE);
  while (info.next_scanline < info.image_height) {
    JSAMPROW row = const_cast<JSAMPROW>(image.pixel(0, static_cast<int>(info.next_scanline)));
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  std::string out(reinterpret_cast<const char*>(bytes), size);
  std::free(bytes);
  return out;
}

TEST(Jpeg, SmoothPixelsSurviveApproximately) {
  const TempDir dir;
  const ImageRgb8 image = smooth(40, 24);
  write_text(dir / "a.jpg", encode(image));
  const ImageRgb8 back = read_rgb8(dir / "a.jpg");
  ASSERT_EQ(back.width, 40);
  ASSERT_EQ(back.height, 24);
  // Quality 98 quantises by one or two steps and halves the resolution of the colour.
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    EXPECT_NEAR(int{back.pixels[i]}, int{image.pixels[i]}, 10);
}

/// Encodes inks as Adobe's programs do: 255 is no ink, and a marker says so.
std::string encode_inks(J_COLOR_SPACE stored, const std::array<JSAMPLE, 4>& inks) {
  jpeg_compress_struct info{};
  jpeg_error_mgr errors;
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&info, &bytes, &size);
  info.image_width = info.image_height = 8;
  info.input_components = 4;
  info.in_color_space = JCS_CMYK;
  jpeg_set_defaults(&info);
  jpeg_set_colorspace(&info, stored);
  jpeg_set_quality(&info, 100, TRUE);
  jpeg_start_compress(&info, TRUE);
  std::vector<JSAMPLE> row;
  for (int x = 0; x < 8; ++x) row.insert(row.end(), inks.begin(), inks.end());
  JSAMPROW rows[] = {row.data()};
  while (info.next_scanline < 8) jpeg_write_scanlines(&info, rows, 1);
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  std::string out(reinterpret_cast<const char*>(bytes), size);
  std::free(bytes);
  return out;
}

TEST(Jpeg, InksBecomeColours) {
  for (const J_COLOR_SPACE stored : {JCS_CMYK, JCS_YCCK}) {
    const std::string bytes = encode_inks(stored, {255, 128, 0, 200});
    const DecodedImage image =
        decode_jpeg({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, "a.jpg");
    EXPECT_EQ(image.channels(), 3);
    EXPECT_NEAR(image.pixel(3, 3)[0] / 257.0, 200, 3);
    EXPECT_NEAR(image.pixel(3, 3)[1] / 257.0, 100, 3);
    EXPECT_NEAR(image.pixel(3, 3)[2] / 257.0, 0, 3);
  }
}

TEST(Jpeg, TruncationAtEveryByteIsRefused) {
  const TempDir dir;
  const std::string bytes = encode(smooth(24, 16));
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    write_text(dir / "cut.jpg", bytes.substr(0, n));
    EXPECT_THROW(read_rgb8(dir / "cut.jpg"), Error) << n << " of " << bytes.size();
  }
}

TEST(Jpeg, OtherFilesAreRefused) {
  const TempDir dir;
  write_text(dir / "text.jpg", "hello, I am not a picture");
  EXPECT_THROW(read_rgb8(dir / "text.jpg"), Error);
  EXPECT_THROW(read_rgb8(dir / "missing.jpg"), Error);
}

}  // namespace
}  // namespace voxdag
