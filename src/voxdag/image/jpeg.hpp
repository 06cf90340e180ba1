#pragma once
/// JPEG files, by libjpeg-turbo. Read only.
#include <filesystem>

#include "voxdag/image/image.hpp"

namespace voxdag {

/// Reads grey, YCbCr and RGB JPEGs, baseline or progressive, as 8-bit sRGB. Throws Error for what
/// is unreadable, truncated, damaged, too large or in another colour space.
ImageRgb8 read_jpeg(const std::filesystem::path& path);

}  // namespace voxdag
