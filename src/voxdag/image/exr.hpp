#pragma once
/// OpenEXR files of named float32 channels, by OpenEXR 3.
#include <filesystem>
#include <string>
#include <vector>

#include "voxdag/image/image.hpp"

namespace voxdag {

/// `channel_names[i]` names channel i of the image: "R", "Z", "N.X" (a dot separates layer and
/// name).
struct ExrImage {
  ImageF image;
  std::vector<std::string> channel_names;
};

/// Writes scan lines with ZIP compression, 32-bit float. The file appears at `path` only when it is
/// complete. Throws Error if it cannot be written, the image has no pixels, or names are not
/// distinct, not empty and one for each channel.
void write_exr(const std::filesystem::path& path, const ImageF& image,
               const std::vector<std::string>& channel_names);

/// Reads the data window of a single-part file, channels sorted by name, half and integer channels
/// as float. Throws Error for what is unreadable, truncated, damaged, subsampled or too large.
ExrImage read_exr(const std::filesystem::path& path);

}  // namespace voxdag
