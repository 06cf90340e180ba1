#pragma once
/// Reads pictures of light: linear values without an upper limit.
#include <filesystem>

#include "voxdag/image/image.hpp"

namespace voxdag {

/// Reads a Radiance HDR or an OpenEXR file of at most 1 GiB to linear R, G and B; the first bytes
/// decide which it is. Negative values, which filters of pictures leave, become 0, infinite ones
/// 65504, the most that a half can hold. Throws Error if the file cannot be read, is neither, is
/// damaged, or has a value that is not a number.
ImageF read_light_image(const std::filesystem::path& path);

}  // namespace voxdag
