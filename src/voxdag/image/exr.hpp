#pragma once
/// Reads and writes OpenEXR files, using OpenEXR 3.
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "voxdag/image/image.hpp"

namespace voxdag {

/// Writes scan lines with ZIP compression, 32-bit float. `channel_names[i]` names channel i of the
/// image: "R", "Z", "N.X" (a dot separates layer and name). The file appears at `path` only when it
/// is complete. Throws Error if the file cannot be written or the image has no pixels. Also throws
/// Error unless there is one name for each channel, and the names are distinct and not empty.
void write_exr(const std::filesystem::path& path, const ImageF& image,
               const std::vector<std::string>& channel_names);

/// Decodes the channels R, G and B, or Y for all three, of an EXR's first part. Errors call the
/// file `name`. Throws Error if the bytes are no EXR, damaged, more than the limits of
/// image_limits.hpp, or have no such channels.
ImageF decode_exr(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace voxdag
