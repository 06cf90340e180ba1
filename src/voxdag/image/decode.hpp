#pragma once
/// Decodes image files of every format that textures use.
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "voxdag/image/decoded_image.hpp"

namespace voxdag {

/// Decodes a PNG or a JPEG; the first bytes tell which. `name` stands for the file in errors.
/// Memory: the pixels, and for a progressive JPEG twice as many bytes again, all counted before it
/// is taken. Throws Error for what is truncated, damaged or beyond the limits of image_limits.hpp,
/// OverMemory, and what `options.poll` throws.
DecodedImage decode_image(std::span<const std::uint8_t> bytes, const std::string& name,
                          const ImageOptions& options = {});

/// Decodes a file of at most 1 GiB, of which it reads only the first page if that is no image.
DecodedImage read_image(const std::filesystem::path& path, const ImageOptions& options = {});

}  // namespace voxdag
