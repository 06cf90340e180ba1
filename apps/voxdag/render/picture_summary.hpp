#pragma once
/// The summary that `voxdag render` prints.
#include <string>

#include "voxdag/render/render_options.hpp"

namespace voxdag::cli {

/// Prints size, time and ray rate of the picture in `file`, and the options that reproduce it.
/// is_up_guessed: whether neither an option nor the scene's input says which way is up.
void print_picture_summary(const std::string& file, const RenderedImage& image, double seconds,
                           const std::string& device, bool is_up_guessed);

}  // namespace voxdag::cli
