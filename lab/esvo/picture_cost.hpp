#pragma once
/// Measures whole pictures of an ESVO, to compare shading and filter with the casts.
#include <span>

#include "voxdag/cuda/device_scene.hpp"
#include "voxdag/file/esvo_file.hpp"
#include "voxdag/image/image_size.hpp"
#include "voxdag/render/view.hpp"

namespace voxdag::lab {

/// Seconds of the pictures of all views.
struct PictureCost {
  double picture = 0;  ///< Primary rays with beams, shading and tone mapping, without the filter.
  double filter = 0;   ///< The filter alone; NaN if it is too fast to measure on a CUDA device.
};

/// Renders one picture per view without shadows and ambient occlusion, as in the ESVO paper, on all
/// threads of the TBB arena or, unless it is null, on the CUDA device of `on_device`, which holds
/// the ESVO. There, pictures include their copies to the host, and the filter's seconds are those
/// of pictures with it less those without. After a warm-up, the fastest of `repeat` turns counts.
PictureCost picture_cost(const EsvoFile& esvo, const DeviceScene* on_device,
                         std::span<const View> views, ImageSize size, float lod_pixels, int repeat);

}  // namespace voxdag::lab
