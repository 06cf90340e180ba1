#pragma once
/// From what is asked of a picture to what kernels take, and from what they make to the picture.
#include <utility>

#include "voxdag/render/render_options.hpp"
#include "voxdag/render/sample_tables.hpp"

namespace voxdag {

/// Owns what a RenderSetup points to, all in the memory of the host.
class RenderPlan {
 public:
  /// Finds the view, the sun and the sample tables, and makes an empty image. The voxels
  /// are the grid's. Throws Error for options out of range.
  RenderPlan(const VoxelScene& voxels, const Grid& grid, const RenderOptions& options);
  RenderPlan(const RenderPlan&) = delete;
  RenderPlan& operator=(const RenderPlan&) = delete;

  /// With pointers to the plan's tables and image; beam_starts is null.
  const RenderSetup& setup() const { return setup_; }
  const SampleSets& samples() const { return samples_; }
  /// Filled by whoever renders, through setup().image; `rays` too.
  RenderedImage& image() { return image_; }

  /// Exposes and tone maps an image's radiance.
  RenderedImage finish(RenderedImage image) const;
  /// Does so with the plan's own, and gives it away.
  RenderedImage finish() { return finish(std::move(image_)); }

 private:
  SampleSets samples_;
  RenderedImage image_;
  RenderSetup setup_;
  float exposure_ = 0;
};

}  // namespace voxdag
