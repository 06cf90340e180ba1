#pragma once
/// Reads JPEG files, using libjpeg-turbo.
#include <cstdint>
#include <span>
#include <string>

#include "voxdag/image/decoded_image.hpp"

namespace voxdag {

/// Returns whether the bytes begin with the signature of a JPEG.
bool is_jpeg(std::span<const std::uint8_t> bytes);

/// Decodes a grey, YCbCr, RGB, CMYK or YCCK JPEG, baseline or progressive, to 1 or 3 channels of 8
/// bits. Inks are multiplied, without colour profiles; those of Adobe's programs are inverted.
/// Errors call the file `name`. Throws Error if the image is truncated, damaged, too large (see
/// image_limits.hpp) or in another colour space, OverMemory, and passes exceptions of
/// `options.poll` on.
DecodedImage decode_jpeg(std::span<const std::uint8_t> bytes, const std::string& name,
                         const ImageOptions& options = {});

}  // namespace voxdag
