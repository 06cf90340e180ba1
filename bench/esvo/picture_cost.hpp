#pragma once
/// Measures whole pictures of an ESVO, to compare shading and filter with the casts.
#include <span>

#include "voxdag/file/esvo_file.hpp"
#include "voxdag/image/image_size.hpp"
#include "voxdag/render/view.hpp"

namespace voxdag {

/// Seconds of the pictures of all views.
struct PictureCost {
  double picture = 0;  ///< Primary rays with beams, shading and tone mapping, without the filter.
  double filter = 0;   ///< The filter alone.
};

/// Renders one picture per view without shadows and ambient occlusion, as in the ESVO paper, on all
/// threads of the TBB arena. After a warm-up, the fastest of `repeat` turns counts.
PictureCost picture_cost(const EsvoFile& esvo, std::span<const View> views, ImageSize size,
                         float lod_pixels, int repeat);

}  // namespace voxdag
