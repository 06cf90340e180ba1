#pragma once
/// JPEG files, by libjpeg-turbo. Read only.
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "voxdag/image/image.hpp"

namespace voxdag {

/// Reads grey, YCbCr and RGB JPEGs, baseline or progressive, as 8-bit sRGB. Throws Error for what
/// is unreadable, truncated, damaged, too large or in another colour space.
ImageRgb8 read_jpeg(const std::filesystem::path& path);

/// As above from memory; `name` stands for the file in errors.
ImageRgb8 decode_jpeg(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace voxdag
