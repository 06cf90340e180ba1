#pragma once
/// Images as plain values. Rows run from top to bottom, pixels from left to right, channels of a
/// pixel lie together.
#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxdag {

/// 8-bit sRGB. `pixels` holds width * height * 3 bytes: R, G, B.
struct ImageRgb8 {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;

  ImageRgb8() = default;
  /// A black image.
  ImageRgb8(int w, int h)
      : width(w),
        height(h),
        pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * 3) {}

  std::uint8_t* pixel(int x, int y) { return pixels.data() + offset(x, y); }
  const std::uint8_t* pixel(int x, int y) const { return pixels.data() + offset(x, y); }
  friend bool operator==(const ImageRgb8&, const ImageRgb8&) = default;

 private:
  std::size_t offset(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
            static_cast<std::size_t>(x)) *
           3;
  }
};

/// Linear float32. `pixels` holds width * height * channels values.
struct ImageF {
  int width = 0, height = 0, channels = 0;
  std::vector<float> pixels;

  ImageF() = default;
  /// All zeros.
  ImageF(int w, int h, int c)
      : width(w),
        height(h),
        channels(c),
        pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) *
               static_cast<std::size_t>(c)) {}

  float* pixel(int x, int y) { return pixels.data() + offset(x, y); }
  const float* pixel(int x, int y) const { return pixels.data() + offset(x, y); }
  friend bool operator==(const ImageF&, const ImageF&) = default;

 private:
  std::size_t offset(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
            static_cast<std::size_t>(x)) *
           static_cast<std::size_t>(channels);
  }
};

/// 16 bits a channel as in the file: 8-bit values times 257, colours sRGB-encoded. `pixels` holds
/// width * height * 4 values: R, G, B and straight alpha, which is 65535 where the file has none.
struct ImageRgba16 {
  int width = 0, height = 0;
  bool has_alpha = false;  ///< The file has an alpha channel or transparent colours.
  std::vector<std::uint16_t> pixels;

  ImageRgba16() = default;
  ImageRgba16(int w, int h)
      : width(w),
        height(h),
        pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * 4) {}

  std::uint16_t* pixel(int x, int y) { return pixels.data() + offset(x, y); }
  const std::uint16_t* pixel(int x, int y) const { return pixels.data() + offset(x, y); }
  friend bool operator==(const ImageRgba16&, const ImageRgba16&) = default;

 private:
  std::size_t offset(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
            static_cast<std::size_t>(x)) *
           4;
  }
};

}  // namespace voxdag
