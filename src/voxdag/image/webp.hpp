#pragma once
/// Reads WebP files, using libwebp.
#include <cstdint>
#include <span>
#include <string>

#include "voxdag/image/decoded_image.hpp"

namespace voxdag {

/// Returns whether the bytes begin with the signature of a WebP.
bool is_webp(std::span<const std::uint8_t> bytes);

/// Decodes a still WebP to 3 or 4 channels of 8 bits. Errors call the file `name`. Throws Error if
/// the image is truncated, damaged, animated or too large (see image_limits.hpp), OverMemory, and
/// passes exceptions of `options.poll` on.
DecodedImage decode_webp(std::span<const std::uint8_t> bytes, const std::string& name,
                         const ImageOptions& options = {});

}  // namespace voxdag
