#pragma once
/// The filter of a picture's voxels, on the CPU.
#include <vector>

#include "voxdag/render/post_filter.hpp"
#include "voxdag/render/render_options.hpp"

namespace voxdag {

/// The filtered colours, on the threads of the current TBB arena; they do not depend on the number
/// of threads.
std::vector<Vec3f> filter_picture(const FilterInput& input);

/// Filters the radiance of a picture, which is to have cell_pixels.
void filter_picture(RenderedImage& image);

}  // namespace voxdag
