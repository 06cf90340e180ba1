#pragma once
/// Renders parts of a picture of an ESVO with missing blocks on a CUDA device.
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/cuda/device_blocks.hpp"
#include "voxdag/render/render_plan.hpp"
#include "voxdag/render/tile.hpp"

namespace voxdag {

/// A picture in the memory of the device of some blocks. Its tiles are the blocks of pixels in
/// render_pixel.hpp.
class PartialPicture {
 public:
  /// `plan` must outlive this object. Throws Error if there is not enough memory.
  PartialPicture(const DeviceBlocks& blocks, const RenderPlan& plan, const RenderOptions& options,
                 Work work);

  /// Returns the number of tiles; they are counted row by row.
  std::uint32_t tile_count() const;
  ViewTile tile(std::uint32_t index) const;

  /// Finds where rays may start, in the blocks that are in memory now, if the options ask for
  /// beams. Rays may start there even if other blocks are in memory later.
  void cast_beams() const;
  /// Renders all samples of the pixels of different tiles. Returns those of the tiles whose rays
  /// missed blocks, and marks these blocks as wanted. `stage` names the work for progress; null: no
  /// reports. Throws Cancelled, and Error if the device fails.
  std::vector<std::uint32_t> render(std::span<const std::uint32_t> tiles, const char* stage) const;
  /// Returns the most tiles that resume() takes: their logs take at most 64 MiB, or are of one
  /// tile.
  std::uint32_t most_resumed() const;
  /// Continues a sample of the pixels of different tiles, in the first call (`begins`) from the
  /// start, and returns the number of tiles whose rays wait for blocks. Marks these blocks as
  /// wanted; each ray goes on from there in a later call with its block in memory. A pixel's
  /// samples must come in order. Throws Cancelled, and Error if the device fails or has not enough
  /// memory for the logs.
  std::size_t resume(std::span<const std::uint32_t> tiles, int sample, bool begins) const;
  /// Sets the picture's steps of primary rays in the blocks that are in memory.
  void count_steps() const;

  /// Copies the picture, without a filter, and its number of rays.
  void copy_to(RenderedImage& image) const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace voxdag
