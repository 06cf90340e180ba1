#pragma once
/// A picture of voxels, on a CUDA device.
#include "voxdag/cuda/device_scene.hpp"
#include "voxdag/parallel/progress.hpp"
#include "voxdag/render/render_options.hpp"
#include "voxdag/render/view_source.hpp"

namespace voxdag {

/// The picture that render_image() makes on the CPU, but for rounding. Surface points of a `source`
/// are found on the threads of the current TBB arena while the device renders. tile_size means
/// nothing here. Throws Error for options out of range, where the device has not enough memory or
/// fails; Cancelled.
RenderedImage render_image(const DeviceScene& scene, const Grid& grid, const RenderOptions& options,
                           Progress* progress = nullptr, const ViewSource* source = nullptr);

}  // namespace voxdag
