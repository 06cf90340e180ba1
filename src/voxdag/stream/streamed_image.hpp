#pragma once
/// A picture of an ESVO whose blocks are loaded while it is made.
#include <functional>

#include "voxdag/cpu/render_image.hpp"
#include "voxdag/stream/streamed_nodes.hpp"

namespace voxdag {

/// Where blocks come from. Nothing is loaded while rays are cast.
class BlockSource {
 public:
  virtual ~BlockSource() = default;

  /// The block that is missing below a leaf of the descriptor in `slot`, or -1. Thread-safe.
  virtual std::int64_t missing_block(std::uint64_t slot) const = 0;
  /// Notes that rays want a missing block. Thread-safe.
  virtual void want(std::size_t block) const = 0;
  /// What is loaded; stays valid while blocks come and go.
  virtual EsvoView view() const = 0;

  /// Loads the blocks that were wanted since the last call, those that look largest from `eye`
  /// first, as long as there is room; blocks that were loaded before the last begin_part() make
  /// some. Returns how many it loaded.
  virtual std::size_t load_missing(Vec3d eye) = 0;
  /// From here on, what is loaded is for a picture, or a part of it.
  virtual void begin_part() = 0;
  /// Loads a block and those above it; those that were wanted longest ago make room.
  virtual void load(std::size_t block) = 0;
};

/// The picture that render_image makes of the whole octree. The first one, of what is loaded at the
/// start, is there at once; then the tiles whose rays missed blocks are rendered again and again,
/// each time with what they missed before. When no more fits, a tile for each thread at a time
/// loads what it needs, and where even that does not fit its rays wait for one block after the
/// other (paged_caster.hpp). What the source has loaded before, for other pictures, is used as long
/// as there is room. `on_pass` gets each whole picture but the last. Throws as render_image does,
/// and what the source throws.
RenderedImage render_streamed(BlockSource& source, const Grid& grid, const RenderOptions& options,
                              const std::function<void(const RenderedImage&)>& on_pass = {},
                              Progress* progress = nullptr);

}  // namespace voxdag
