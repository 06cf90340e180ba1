#pragma once
/// The pixels of an image file, with no more channels and bits than the file has.
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>

#include "voxdag/core/memory_budget.hpp"

namespace voxdag {

/// Options for decoding images and making textures.
struct ImageOptions {
  /// Counts pixels and texels as long as they live, so it must outlive them. Null: no limit.
  MemoryBudget* memory = nullptr;
  /// If not empty: called at least every 0.2 s; throws to stop the work.
  std::function<void()> poll = {};

  void call_poll() const {
    if (poll) poll();
  }
};

/// 1 to 4 channels (grey, grey and alpha, RGB, RGB and alpha) of 8 or 16 bits. Colours are encoded
/// as in the file, which is sRGB; alpha is straight. Rows run from top to bottom.
class DecodedImage {
 public:
  /// Red, green, blue and alpha on the scale of 16 bits.
  using Rgba = std::array<std::uint16_t, 4>;

  DecodedImage() = default;
  /// Makes an image of zeros. Throws OverMemory.
  DecodedImage(int width, int height, int channels, int bytes_per_sample, MemoryBudget* memory)
      : width_(width),
        height_(height),
        channels_(channels),
        bytes_per_sample_(bytes_per_sample),
        bytes_(row_bytes() * static_cast<std::size_t>(height),
               CountedAllocator<std::uint8_t>(memory)) {
    assert(width > 0 && height > 0 && channels >= 1 && channels <= 4);
    assert(bytes_per_sample == 1 || bytes_per_sample == 2);
  }

  int width() const { return width_; }
  int height() const { return height_; }
  int channels() const { return channels_; }
  bool is_empty() const { return width_ == 0; }
  /// Returns whether the file has an alpha channel or transparent colours.
  bool has_alpha() const { return channels_ % 2 == 0 && channels_ > 0; }
  std::size_t bytes() const { return bytes_.size(); }

  std::size_t row_bytes() const {
    return static_cast<std::size_t>(width_) * static_cast<std::size_t>(channels_) *
           static_cast<std::size_t>(bytes_per_sample_);
  }
  /// Returns the samples of a row. Samples of 16 bits are in the machine's byte order.
  std::uint8_t* row(int y) { return bytes_.data() + static_cast<std::size_t>(y) * row_bytes(); }
  const std::uint8_t* row(int y) const {
    return bytes_.data() + static_cast<std::size_t>(y) * row_bytes();
  }

  /// Returns a pixel. 8-bit values are multiplied by 257, grey is copied to all three colours, and
  /// alpha is 65535 if there is none.
  Rgba pixel(int x, int y) const {
    const auto count = static_cast<std::size_t>(channels_);
    const std::size_t first = static_cast<std::size_t>(x) * count;
    std::uint16_t samples[4] = {};
    if (bytes_per_sample_ == 1) {
      const std::uint8_t* from = row(y) + first;
      for (std::size_t c = 0; c < count; ++c)
        samples[c] = static_cast<std::uint16_t>(from[c] * 257);
    } else {
      std::memcpy(samples, row(y) + 2 * first, 2 * count);
    }
    const std::uint16_t alpha = has_alpha() ? samples[count - 1] : std::uint16_t{65535};
    if (count < 3) return {samples[0], samples[0], samples[0], alpha};
    return {samples[0], samples[1], samples[2], alpha};
  }

  /// Sets a pixel of an image with 4 channels of 16 bits.
  void set_pixel(int x, int y, const Rgba& rgba) {
    assert(channels_ == 4 && bytes_per_sample_ == 2);
    std::memcpy(row(y) + static_cast<std::size_t>(x) * sizeof rgba, rgba.data(), sizeof rgba);
  }

 private:
  int width_ = 0, height_ = 0, channels_ = 0, bytes_per_sample_ = 1;
  CountedVector<std::uint8_t> bytes_;
};

}  // namespace voxdag
