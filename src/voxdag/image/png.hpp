#pragma once
/// PNG files, by libpng.
#include <filesystem>

#include "voxdag/image/image.hpp"

namespace voxdag {

/// Writes 8-bit RGB marked as sRGB. The file appears at `path` only when it is complete. Throws
/// Error if it cannot be written or the image has no pixels.
void write_png(const std::filesystem::path& path, const ImageRgb8& image);

/// Reads any PNG as 8-bit sRGB: grey and palette become RGB, 16 bits become 8, alpha is dropped
/// without blending. Throws Error for what is unreadable, truncated, damaged or too large.
ImageRgb8 read_png(const std::filesystem::path& path);

}  // namespace voxdag
