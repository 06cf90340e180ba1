#pragma once
/// PNG files, by libpng.
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "voxdag/image/image.hpp"

namespace voxdag {

/// Writes 8-bit RGB marked as sRGB. The file appears at `path` only when it is complete. Throws
/// Error if it cannot be written or the image has no pixels.
void write_png(const std::filesystem::path& path, const ImageRgb8& image);

/// Reads any PNG as 8-bit sRGB: grey and palette become RGB, 16 bits become 8, alpha is dropped
/// without blending. Throws Error for what is unreadable, truncated, damaged or too large.
ImageRgb8 read_png(const std::filesystem::path& path);

/// Decodes any PNG with its alpha and all its bits; gamma and colour profiles are ignored. `name`
/// stands for the file in errors, which are those of read_png.
ImageRgba16 decode_png_rgba16(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace voxdag
