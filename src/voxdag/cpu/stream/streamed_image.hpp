#pragma once
/// Renders a picture of an ESVO, and loads blocks as rays need them.
#include <functional>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/cpu/render_image.hpp"
#include "voxdag/cpu/stream/streamed_nodes.hpp"

namespace voxdag {

/// A source of blocks. Blocks are not loaded while rays are cast.
class BlockSource {
 public:
  virtual ~BlockSource() = default;

  /// Records that rays want a missing block. Thread-safe.
  virtual void want(std::size_t block) const = 0;
  /// Returns the loaded octree. The view's pointers stay valid when blocks are loaded and evicted.
  virtual PartialEsvoView loaded() const = 0;
  EsvoView view() const { return loaded().octree; }
  /// Returns the number of blocks in the file.
  virtual std::size_t block_count() const = 0;
  /// Returns the number of a block's ancestors.
  virtual int depth(std::size_t block) const = 0;
  /// As in EsvoStream: for copies of loaded().
  virtual std::uint64_t version() const = 0;
  virtual std::vector<SlotRange> changes_since(std::uint64_t version) const = 0;

  /// Loads the blocks that were wanted since the last call, in the order of their apparent size
  /// from `eye`, while there is room. To make room, evicts blocks that were loaded before the last
  /// begin_part(). Returns the number of blocks that it loaded.
  virtual std::size_t load_missing(Vec3d eye) = 0;
  /// Begins a picture or a part of one. Blocks loaded from now on are for it.
  virtual void begin_part() = 0;
  /// Loads a block and its ancestors; evicts the least recently wanted blocks to make room.
  virtual void load(std::size_t block) = 0;
};

/// Returns the picture that render_image() makes of the whole octree, rendered in passes. The first
/// pass uses the blocks that are loaded at the start. Each further pass loads the blocks that rays
/// missed, and renders the tiles of these rays again. When no more blocks fit, each remaining tile
/// loads its own blocks, one tile per thread at a time. If even the blocks of one tile do not fit,
/// its rays wait for one block after another (paged_caster.hpp). Blocks that the source loaded for
/// other pictures stay loaded while there is room. Calls `on_pass` with each complete picture but
/// the last. Throws like render_image and like the source.
RenderedImage render_streamed(BlockSource& source, const Grid& grid, const RenderOptions& options,
                              const std::function<void(const RenderedImage&)>& on_pass = {},
                              Work work = {});

}  // namespace voxdag
