#include "voxdag/image/jpeg_writer.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "voxdag/core/error.hpp"
#include "voxdag/image/jpeg.hpp"

namespace voxdag {
namespace {

TEST(JpegWriter, ThePictureIsReadBackWithSmallErrors) {
  ImageRgb8 image(61, 40);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c)
        image.pixel(x, y)[c] = static_cast<std::uint8_t>(120 + 100 * std::sin(0.1 * (x + c * y)));
  const std::string bytes = encode_jpeg(image, 95);
  const DecodedImage back =
      decode_jpeg({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, "a.jpg");
  ASSERT_EQ(back.width(), 61);
  ASSERT_EQ(back.height(), 40);
  double sum = 0;
  for (int y = 0; y < 40; ++y)
    for (int i = 0; i < 61 * 3; ++i) sum += std::abs(back.row(y)[i] - image.pixel(0, y)[i]);
  EXPECT_LT(sum / (61 * 40 * 3), 4);  // Of 255: colours have half the resolution.
  EXPECT_EQ(bytes, encode_jpeg(image, 95));
}

TEST(JpegWriter, AnEmptyImageIsAnError) { EXPECT_THROW(encode_jpeg({}, 75), Error); }

}  // namespace
}  // namespace voxdag
