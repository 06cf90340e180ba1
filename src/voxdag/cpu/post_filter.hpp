#pragma once
/// Runs the filter of render/post_filter.hpp on the CPU.
#include <vector>

#include "voxdag/render/post_filter.hpp"
#include "voxdag/render/render_options.hpp"

namespace voxdag {

/// Returns the filtered colours. Runs on the threads of the current TBB arena; the result does not
/// depend on their number.
std::vector<Vec3f> filter_picture(const FilterInput& input);

/// Filters the radiance of a picture, which must have cell_pixels unless `kind` is kNone.
void filter_picture(RenderedImage& image, FilterKind kind);

}  // namespace voxdag
