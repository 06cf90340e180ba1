#pragma once
/// Reads and writes PNG files, using libpng.
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "voxdag/image/decoded_image.hpp"
#include "voxdag/image/image.hpp"

namespace voxdag {

/// Writes 8-bit RGB marked as sRGB. The file appears at `path` only when it is complete. Throws
/// Error if it cannot be written or the image has no pixels. `alpha` has one value for each pixel;
/// empty: the file has no alpha.
void write_png(const std::filesystem::path& path, const ImageRgb8& image,
               std::span<const std::uint8_t> alpha = {});

/// Returns whether the bytes begin with the signature of a PNG.
bool is_png(std::span<const std::uint8_t> bytes);

/// Decodes any PNG with its alpha. Palette indices become colours; values of less than 8 bits are
/// expanded to 8 bits; gamma and colour profiles are ignored. Errors call the file `name`. Throws
/// Error if the image is truncated, damaged or too large (see image_limits.hpp), OverMemory, and
/// passes exceptions of `options.poll` on.
DecodedImage decode_png(std::span<const std::uint8_t> bytes, const std::string& name,
                        const ImageOptions& options = {});

}  // namespace voxdag
