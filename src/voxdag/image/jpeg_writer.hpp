#pragma once
/// Writes JPEG files, using libjpeg-turbo.
#include <string>

#include "voxdag/image/image.hpp"

namespace voxdag {

/// Returns the bytes of a baseline JPEG. `quality` is from 1 to 100; sides are from 1 to 65,500
/// pixels. Throws Error if libjpeg cannot write the image.
std::string encode_jpeg(const ImageRgb8& image, int quality);

}  // namespace voxdag
