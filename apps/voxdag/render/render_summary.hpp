#pragma once
/// What `voxdag render` says of a picture.
#include <string>

#include "voxdag/render/render_options.hpp"

namespace voxdag {

/// Prints size, time and rate of the picture in `file`, and the options that make it again.
void print_summary(const std::string& file, const RenderedImage& image, double seconds,
                   const std::string& device);

}  // namespace voxdag
