#pragma once
/// The passes of a streamed picture, for any device that renders its tiles.
#include <functional>
#include <vector>

#include "voxdag/cpu/stream/streamed_image.hpp"
#include "voxdag/render/render_plan.hpp"
#include "voxdag/render/tile.hpp"

namespace voxdag {

/// Renders tiles of a picture with the blocks that a BlockSource has loaded.
class StreamedTiles {
 public:
  virtual ~StreamedTiles() = default;

  /// Returns tiles that cover the picture.
  virtual std::vector<ViewTile> all() const = 0;
  /// Prepares for the blocks that are loaded now: beams end at the loaded voxels.
  virtual void begin_pass() = 0;
  /// Renders tiles with the loaded blocks, and makes the source want the blocks that rays missed.
  /// Returns the tiles of these rays, in order. `stage` names the work for progress; null: no
  /// reports. Throws Cancelled.
  virtual std::vector<ViewTile> render(const std::vector<ViewTile>& tiles, const char* stage) = 0;
  /// Renders tiles whose blocks do not fit into memory together, and loads blocks meanwhile.
  virtual void render_rest(const std::vector<ViewTile>& tiles) = 0;
  /// Sets the steps of primary rays in the loaded blocks.
  virtual void count_steps() = 0;

  /// Returns the picture so far, before the filter.
  virtual RenderedImage image() = 0;
  /// Returns the finished picture, before the filter.
  virtual RenderedImage take_image() = 0;
};

/// Renders a picture in passes, as render_streamed() (streamed_image.hpp) describes. `plan` and
/// `options` are those of `tiles`.
RenderedImage render_passes(BlockSource& source, StreamedTiles& tiles, const RenderPlan& plan,
                            const RenderOptions& options,
                            const std::function<void(const RenderedImage&)>& on_pass);

}  // namespace voxdag
