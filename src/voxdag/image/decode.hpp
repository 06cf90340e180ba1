#pragma once
/// Decodes image files of every format that textures use.
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "voxdag/image/decoded_image.hpp"

namespace voxdag {

/// Decodes a PNG, JPEG, WebP, BMP or TGA; the first bytes decide which. Errors call the file
/// `name`. Counts its memory before it allocates: the pixels, for a progressive JPEG twice as many
/// bytes in addition, and for a WebP, BMP or TGA four bytes a pixel. Throws Error if the image is
/// truncated, damaged or beyond the limits of image_limits.hpp, OverMemory, and passes exceptions
/// of `options.poll` on.
DecodedImage decode_image(std::span<const std::uint8_t> bytes, const std::string& name,
                          const ImageOptions& options = {});

/// Decodes a file of at most 1 GiB. If the first page is not the start of an image, reads no more.
/// Throws like decode_image(), and Error if the file cannot be read.
DecodedImage read_image(const std::filesystem::path& path, const ImageOptions& options = {});

}  // namespace voxdag
