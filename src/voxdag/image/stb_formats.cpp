#include "voxdag/image/stb_formats.hpp"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_BMP
#define STBI_ONLY_HDR
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#include <stb/stb_image.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

#include "voxdag/core/error.hpp"
#include "voxdag/image/image_limits.hpp"

namespace voxdag {
namespace {

std::uint64_t little_endian(std::span<const std::uint8_t> bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value |= std::uint64_t{bytes[at + i]} << (8 * i);
  return value;
}

/// Returns the number of bytes that a TGA with this header has, or more than the given bytes if
/// they do not have all pixels.
std::uint64_t tga_bytes(std::span<const std::uint8_t> bytes) {
  const std::uint64_t map_entry = (bytes[7] + 7u) / 8, pixel = (bytes[16] + 7u) / 8;
  std::uint64_t left = little_endian(bytes, 12, 2) * little_endian(bytes, 14, 2);
  std::uint64_t at = 18 + bytes[0] + (bytes[1] != 0 ? little_endian(bytes, 5, 2) * map_entry : 0);
  const bool has_runs = bytes[2] >= 8;
  if (!has_runs) return at + left * pixel;
  while (left > 0 && at < bytes.size()) {
    const std::uint64_t count = (bytes[at] & 127u) + 1;
    at += 1 + ((bytes[at] & 128u) != 0 ? 1 : count) * pixel;
    left -= std::min(left, count);
  }
  return at + left;
}

/// Returns the number of bytes that a BMP with this header has.
std::uint64_t bmp_bytes(std::span<const std::uint8_t> bytes, std::uint64_t width,
                        std::uint64_t height) {
  const std::uint64_t bits = little_endian(bytes, little_endian(bytes, 14, 4) == 12 ? 24 : 28, 2);
  return little_endian(bytes, 10, 4) + (height - 1) * ((width * bits + 31) / 32 * 4) +
         (width * bits + 7) / 8;
}

}  // namespace

std::optional<DecodedImage> decode_tga_or_bmp(std::span<const std::uint8_t> bytes,
                                              const std::string& name,
                                              const ImageOptions& options) {
  const bool is_bmp = bytes.size() > 2 && bytes[0] == 'B' && bytes[1] == 'M';
  const char* const kind = is_bmp ? "BMP" : "TGA";
  const auto size = static_cast<int>(bytes.size());
  int width = 0, height = 0, channels = 0;
  if (stbi_is_hdr_from_memory(bytes.data(), size) != 0) return std::nullopt;
  if (bytes.size() < (is_bmp ? 30u : 18u) ||
      stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) == 0) {
    if (!is_bmp) return std::nullopt;
    throw Error(name, "header", "this kind of BMP image is not read");
  }
  height = std::abs(height);
  check_image_size(name, static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height));
  // stb_image takes missing bytes for zeros.
  if ((is_bmp
           ? bmp_bytes(bytes, static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height))
           : tga_bytes(bytes)) > bytes.size())
    throw Error(name, ErrorPlace::byte(bytes.size()),
                std::string("the ") + kind + " file is truncated");
  const MemoryReservation work(
      options.memory, 4 * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height));
  options.call_poll();
  const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
      stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 0), &stbi_image_free);
  if (!pixels)
    throw Error(name, "",
                std::string("cannot read this ") + kind + " image: " + stbi_failure_reason());
  DecodedImage image(width, height, channels, 1, options.memory);
  std::copy_n(pixels.get(), image.bytes(), image.row(0));
  if (!is_bmp && (bytes[17] & 0x10) != 0) {  // Right to left, which stb_image ignores.
    const auto pixel = static_cast<std::size_t>(channels);
    for (int y = 0; y < height; ++y)
      for (std::size_t a = 0, b = static_cast<std::size_t>(width) - 1; a < b; ++a, --b)
        std::swap_ranges(image.row(y) + a * pixel, image.row(y) + (a + 1) * pixel,
                         image.row(y) + b * pixel);
  }
  return image;
}

ImageF decode_hdr(std::span<const std::uint8_t> bytes, const std::string& name) {
  const auto size = static_cast<int>(bytes.size());
  int width = 0, height = 0, channels = 0;
  if (stbi_is_hdr_from_memory(bytes.data(), size) == 0 ||
      stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) == 0)
    throw Error(name, "header", "not a Radiance HDR image");
  check_image_size(name, static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height));
  // A row of runs has at least 2 bytes for each 127 values. stb_image does not tell where bytes
  // end too early: it takes missing ones for zeros.
  const std::uint64_t least =
      static_cast<std::uint64_t>(height) * (static_cast<std::uint64_t>(width) * 4 / 127 * 2);
  if (bytes.size() < least) throw Error(name, "", "the HDR image is truncated");
  const std::unique_ptr<float, decltype(&stbi_image_free)> pixels(
      stbi_loadf_from_memory(bytes.data(), size, &width, &height, &channels, 3), &stbi_image_free);
  if (!pixels)
    throw Error(name, "", std::string("cannot read this HDR image: ") + stbi_failure_reason());
  ImageF image(width, height, 3);
  std::copy_n(pixels.get(), image.pixels.size(), image.pixels.data());
  return image;
}

}  // namespace voxdag
