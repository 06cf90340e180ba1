#pragma once
/// Renders a picture of voxels on a CUDA device.
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/cuda/device_scene.hpp"
#include "voxdag/render/render_options.hpp"
#include "voxdag/render/view_source.hpp"

namespace voxdag {

/// Returns the picture that render_image() makes on the CPU, up to rounding. The threads of the
/// current TBB arena find surface points of a `source` while the device renders. Ignores tile_size.
/// Throws Error for options out of range, if the device fails, and if its memory is too small.
/// Throws Cancelled.
RenderedImage render_image(const DeviceScene& scene, const Grid& grid, const RenderOptions& options,
                           Work work = {}, const ViewSource* source = nullptr);

}  // namespace voxdag
