#pragma once
/// A picture of a DAG, on the CPU.
#include <optional>
#include <vector>

#include "voxdag/core/grid.hpp"
#include "voxdag/layout/svdag.hpp"
#include "voxdag/parallel/progress.hpp"
#include "voxdag/render/shade.hpp"
#include "voxdag/render/view.hpp"

namespace voxdag {

struct RenderOptions {
  int width = 1920, height = 1080;  ///< Pixels; at least 1 each.
  ViewRequest view;                 ///< What is not set, frame_scene finds.
  std::optional<Vec3d> sun;   ///< Towards the sun; without it, over the viewer's left shoulder.
  int samples_per_pixel = 1;  ///< At least 1; averaged in linear light.
  ShadeOptions shade;
};

/// Rows from top to bottom, pixels from left to right, width * height values each.
struct RenderedImage {
  int width = 0, height = 0;
  View view;                  ///< The view it shows.
  std::vector<Vec3f> rgb;     ///< Tone mapped, linear light in [0,1]: encode as sRGB to display.
  std::vector<float> depth;   ///< World units along the view axis; +infinity where nothing is.
  std::vector<Vec3f> normal;  ///< World space, unit length; zero where nothing is.
  std::uint64_t rays = 0;     ///< Rays cast, primary and shadow.
};

/// Renders on the threads of the current TBB arena, tile by tile; the pixels do not depend on their
/// number. Depth and normal are those of a pixel's first sample. The DAG must be valid (see
/// validate_svdag) and have the grid's levels. Throws Error for options out of range, Cancelled.
RenderedImage render_image(const SvdagView& dag, const Grid& grid, const RenderOptions& options,
                           Progress* progress = nullptr);

}  // namespace voxdag
