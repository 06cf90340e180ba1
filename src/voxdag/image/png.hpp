#pragma once
/// PNG files, by libpng.
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "voxdag/image/decoded_image.hpp"
#include "voxdag/image/image.hpp"

namespace voxdag {

/// Writes 8-bit RGB marked as sRGB. The file appears at `path` only when it is complete. Throws
/// Error if it cannot be written or the image has no pixels.
void write_png(const std::filesystem::path& path, const ImageRgb8& image);

/// Returns whether the bytes begin as a PNG does.
bool is_png(std::span<const std::uint8_t> bytes);

/// Decodes any PNG with its alpha. Palettes become colours, values of less than 8 bits 8 bits;
/// gamma and colour profiles are ignored. `name` stands for the file in errors. Throws Error for
/// what is truncated, damaged or too large (see image_limits.hpp), OverMemory, and what
/// `options.poll` throws.
DecodedImage decode_png(std::span<const std::uint8_t> bytes, const std::string& name,
                        const ImageOptions& options = {});

}  // namespace voxdag
