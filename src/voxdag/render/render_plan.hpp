#pragma once
/// Converts a picture's options to the setup of the kernels, and their output to the picture.
#include <utility>

#include "voxdag/render/render_options.hpp"
#include "voxdag/render/sample_tables.hpp"

namespace voxdag {

/// Owns the tables and buffers that a RenderSetup points to, in the host's memory.
class RenderPlan {
 public:
  /// Finds the view and the sun, and makes the sample tables and an empty image. `voxels` must be
  /// in `grid`. Throws Error for options out of range.
  RenderPlan(const VoxelSet& voxels, const Grid& grid, const RenderOptions& options);
  RenderPlan(const RenderPlan&) = delete;
  RenderPlan& operator=(const RenderPlan&) = delete;

  /// Returns the setup. It points to the plan's tables and image; beam_starts is null.
  const RenderSetup& setup() const { return setup_; }
  const SampleSets& samples() const { return samples_; }
  /// Returns the image. Renderers fill it through setup().image, and set `rays`.
  RenderedImage& image() { return image_; }

  /// Exposes and tone maps an image's radiance, and puts the background behind its surfaces.
  RenderedImage finish(RenderedImage image) const;
  /// Exposes and tone maps the plan's image, and moves it out.
  RenderedImage finish() { return finish(std::move(image_)); }

 private:
  /// Returns the colour of the background where the sky has this radiance.
  Vec3f background_at(Vec3f sky) const;
  /// Returns the id of a cell's material; kMaxMaterials if it has none.
  std::uint32_t material_of(const SeenCell& cell) const;

  SampleSets samples_;
  RenderedImage image_;
  RenderSetup setup_;
  float exposure_ = 0;
  ToneMap tone_;
  Background background_;
  ColoredDagView materials_;
  std::shared_ptr<const Environment> environment_;  ///< Owns the map of the setup's sky.
};

}  // namespace voxdag
