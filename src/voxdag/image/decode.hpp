#pragma once
/// Image files of any format that textures come in.
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "voxdag/image/image.hpp"

namespace voxdag {

/// Decodes PNG (with alpha and 16 bits) or JPEG, told apart by content. `name` stands for the file
/// in errors. Throws Error.
ImageRgba16 decode_image(std::span<const std::uint8_t> bytes, const std::string& name);

/// As above from a file.
ImageRgba16 read_image(const std::filesystem::path& path);

}  // namespace voxdag
