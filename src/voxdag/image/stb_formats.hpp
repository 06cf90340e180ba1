#pragma once
/// Reads TGA, BMP and Radiance HDR files, using stb_image.
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "voxdag/image/decoded_image.hpp"
#include "voxdag/image/image.hpp"

namespace voxdag {

/// Decodes a TGA or a BMP to 1 to 4 channels of 8 bits; returns nothing if the bytes are neither. A
/// TGA has no signature: its header must make sense. Errors call the file `name`. Counts its memory
/// before it allocates: the pixels twice. Cannot be interrupted. Throws Error if the image is
/// truncated, too large (see image_limits.hpp) or of a kind that is not read (a BMP with run
/// lengths), and OverMemory.
std::optional<DecodedImage> decode_tga_or_bmp(std::span<const std::uint8_t> bytes,
                                              const std::string& name,
                                              const ImageOptions& options = {});

/// Decodes a Radiance HDR (.hdr, .pic) to linear R, G and B. Errors call the file `name`. Throws
/// Error if the bytes are no such image, truncated, or more than the limits of image_limits.hpp.
ImageF decode_hdr(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace voxdag
