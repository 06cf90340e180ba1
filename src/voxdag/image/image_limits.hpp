#pragma once
/// Limits on the cost of a hostile image file.
#include <cstdint>
#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/open_input.hpp"

namespace voxdag {

/// The maximum size of an image file.
inline constexpr SizeLimit kMaxImageFile{std::uint64_t{1} << 30, "an image"};

/// The maximum number of pixels: 16,384 x 16,384.
inline constexpr std::uint64_t kMaxImagePixels = std::uint64_t{1} << 28;
inline constexpr std::uint32_t kMaxImageSide = 1'000'000;

/// The maximum number of scans of a progressive JPEG, which is decoded once per scan. Usual files
/// have about 10 scans.
inline constexpr int kMaxJpegScans = 64;
/// The maximum of scans times pixels: 16 scans of the largest image.
inline constexpr std::uint64_t kMaxJpegScanPixels = std::uint64_t{1} << 32;

/// Throws Error if an image has no pixels or too many.
inline void check_image_size(const std::string& name, std::uint64_t width, std::uint64_t height) {
  if (width == 0 || height == 0 || width > kMaxImageSide || height > kMaxImageSide ||
      width * height > kMaxImagePixels)
    throw Error(name, "header",
                "the image has " + std::to_string(width) + " x " + std::to_string(height) +
                    " pixels; 1 to " + std::to_string(kMaxImagePixels) +
                    " are allowed, and at most " + std::to_string(kMaxImageSide) + " a side");
}

}  // namespace voxdag
