#include "voxdag/image/webp.hpp"

#include <webp/decode.h>

#include <algorithm>
#include <memory>

#include "voxdag/core/error.hpp"
#include "voxdag/image/image_limits.hpp"

namespace voxdag {

bool is_webp(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 12 && std::memcmp(bytes.data(), "RIFF", 4) == 0 &&
         std::memcmp(bytes.data() + 8, "WEBP", 4) == 0;
}

DecodedImage decode_webp(std::span<const std::uint8_t> bytes, const std::string& name,
                         const ImageOptions& options) {
  if (!is_webp(bytes)) throw Error(name, "byte 0", "not a WebP file");
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(bytes.data(), bytes.size(), &features) != VP8_STATUS_OK)
    throw Error(name, "header", "damaged WebP file: the header is truncated or malformed");
  if (features.has_animation != 0)
    throw Error(name, "", "an animated WebP image: only still ones are read");
  check_image_size(name, static_cast<std::uint64_t>(features.width),
                   static_cast<std::uint64_t>(features.height));
  const int channels = features.has_alpha != 0 ? 4 : 3;
  // The decoder keeps four bytes a pixel of a lossless image, and some rows of others.
  const MemoryReservation work(options.memory, 4 * static_cast<std::uint64_t>(features.width) *
                                                   static_cast<std::uint64_t>(features.height));
  DecodedImage image(features.width, features.height, channels, 1, options.memory);
  const std::unique_ptr<WebPIDecoder, decltype(&WebPIDelete)> decoder(
      WebPINewRGB(channels == 4 ? MODE_RGBA : MODE_RGB, image.row(0), image.bytes(),
                  static_cast<int>(image.row_bytes())),
      &WebPIDelete);
  if (!decoder) throw OverMemory(name, "", "not enough memory for the decoder");
  constexpr std::size_t kStep = 1 << 16;
  VP8StatusCode status = VP8_STATUS_SUSPENDED;
  for (std::size_t n = 0; status == VP8_STATUS_SUSPENDED && n < bytes.size();) {
    options.call_poll();
    n = std::min(n + kStep, bytes.size());
    status = WebPIUpdate(decoder.get(), bytes.data(), n);
  }
  if (status == VP8_STATUS_SUSPENDED)
    throw Error(name, ErrorPlace::byte(bytes.size()), "the WebP file is truncated");
  if (status != VP8_STATUS_OK) throw Error(name, "", "damaged WebP file: its pixels are malformed");
  return image;
}

}  // namespace voxdag
