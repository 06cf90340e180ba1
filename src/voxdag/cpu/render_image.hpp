#pragma once
/// Renders a picture of voxels on the CPU.
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/cpu/cpu_scene.hpp"
#include "voxdag/render/render_options.hpp"
#include "voxdag/render/view_source.hpp"

namespace voxdag {

/// Renders tile by tile, on the threads of the current TBB arena; the picture does not depend on
/// their number. Takes the surface points from `source`, or from the voxels if it is null. Depth
/// and normal are from a pixel's first sample. The scene must be valid and have the grid's levels.
/// Throws Error for options out of range, and Cancelled.
RenderedImage render_image(const CpuScene& scene, const Grid& grid, const RenderOptions& options,
                           Work work = {}, const ViewSource* source = nullptr);

}  // namespace voxdag
