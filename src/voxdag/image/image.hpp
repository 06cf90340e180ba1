#pragma once
/// Images as plain values, for rendered pictures. Rows run from top to bottom, pixels from left to
/// right; the channels of a pixel are adjacent.
#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxdag {

/// `pixels` holds width * height * channels values.
template <class Sample>
struct Image {
  int width = 0, height = 0, channels = 0;
  std::vector<Sample> pixels;

  Image() = default;
  /// Makes an image of zeros.
  Image(int w, int h, int c)
      : width(w),
        height(h),
        channels(c),
        pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) *
               static_cast<std::size_t>(c)) {}

  Sample* pixel(int x, int y) { return pixels.data() + offset(x, y); }
  const Sample* pixel(int x, int y) const { return pixels.data() + offset(x, y); }
  friend bool operator==(const Image&, const Image&) = default;

 private:
  std::size_t offset(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
            static_cast<std::size_t>(x)) *
           static_cast<std::size_t>(channels);
  }
};

/// Linear float32, any number of channels.
using ImageF = Image<float>;

/// 8-bit sRGB.
struct ImageRgb8 : Image<std::uint8_t> {
  ImageRgb8() = default;
  /// Makes a black image.
  ImageRgb8(int w, int h) : Image(w, h, 3) {}
};

}  // namespace voxdag
