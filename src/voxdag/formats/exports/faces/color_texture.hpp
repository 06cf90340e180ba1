#pragma once
/// An image with a pixel for each colour, for programs that show no colours of corners.
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "voxdag/core/vec2.hpp"
#include "voxdag/image/image.hpp"
#include "voxdag/stored/attributes/value_pages.hpp"

namespace voxdag {

/// Collects colours, then gives each a pixel, in the order of their codes. Holds 3 MiB if there are
/// colours.
class ColorTexture {
 public:
  void add(Value8 color) {
    if (used_.empty()) used_.resize(kCodes / 64);
    used_[code_of(color) / 64] |= std::uint64_t{1} << (code_of(color) % 64);
  }
  /// Call it after the last add().
  void finish() {
    std::uint32_t count = 0;
    for (const std::uint64_t word : used_) {
      before_.push_back(count);
      count += static_cast<std::uint32_t>(std::popcount(word));
    }
    side_ = static_cast<std::uint32_t>(std::ceil(std::sqrt(count)));
  }

  /// Returns the place of an added colour: the middle of its pixel. (0, 0) is the upper left
  /// corner.
  Vec2f uv(Value8 color) const {
    const std::uint32_t pixel = index_of(color);
    const auto middle = [&](std::uint32_t i) {
      return (static_cast<float>(i) + 0.5f) / static_cast<float>(side_);
    };
    return {middle(pixel % side_), middle(pixel / side_)};
  }
  /// Returns the image, a square of up to 4096 pixels a side.
  ImageRgb8 image() const {
    ImageRgb8 image(static_cast<int>(side_), static_cast<int>(side_));
    std::size_t at = 0;
    for_each([&](std::uint32_t code) {
      for (const int shift : {16, 8, 0})
        image.pixels[at++] = static_cast<std::uint8_t>(code >> shift);
    });
    return image;
  }

  /// Returns the number of an added colour, from 0, in the order of their codes.
  std::uint32_t index_of(Value8 color) const {
    const std::uint32_t code = code_of(color), word = code / 64;
    const std::uint64_t below = (std::uint64_t{1} << (code % 64)) - 1;
    return before_[word] + static_cast<std::uint32_t>(std::popcount(used_[word] & below));
  }
  /// Calls fn(code) for the added colours in their order: 0xRRGGBB.
  template <class Fn>
  void for_each(const Fn& fn) const {
    for (std::uint32_t i = 0; i < used_.size(); ++i)
      for (std::uint64_t left = used_[i]; left != 0; left &= left - 1)
        fn(64 * i + static_cast<std::uint32_t>(std::countr_zero(left)));
  }

 private:
  static constexpr std::uint32_t kCodes = std::uint32_t{1} << 24;

  static std::uint32_t code_of(Value8 color) {
    return std::uint32_t{color.x} << 16 | std::uint32_t{color.y} << 8 | color.z;
  }

  std::vector<std::uint64_t> used_;    ///< A bit for each code.
  std::vector<std::uint32_t> before_;  ///< The colours before each word of `used_`.
  std::uint32_t side_ = 0;
};

}  // namespace voxdag
