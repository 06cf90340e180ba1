#pragma once
/// Loads the blocks of an ESVO file when rays need them.
#include <atomic>
#include <filesystem>
#include <memory>
#include <vector>

#include "voxdag/cpu/stream/esvo_stream.hpp"
#include "voxdag/cpu/stream/streamed_image.hpp"

namespace voxdag {

class StreamBlocks : public BlockSource {
 public:
  /// `memory` limits the bytes of the loaded blocks. Throws Error like EsvoStream.
  StreamBlocks(const std::filesystem::path& path, std::uint64_t memory);

  const EsvoStream& stream() const { return stream_; }

  PartialEsvoView loaded() const override { return stream_.loaded(); }
  std::size_t block_count() const override { return stream_.directory().size(); }
  int depth(std::size_t block) const override;
  std::uint64_t version() const override { return stream_.version(); }
  std::vector<SlotRange> changes_since(std::uint64_t version) const override {
    return stream_.changes_since(version);
  }
  std::size_t load_missing(Vec3d eye) override;
  void begin_part() override { ++part_; }
  void want(std::size_t block) const override {
    wanted_[block].store(true, std::memory_order_relaxed);
  }
  void load(std::size_t block) override;

 private:
  /// Returns the blocks wanted since the last call, in order.
  std::vector<std::size_t> take_wanted();
  /// Returns the approximate apparent size of the block's voxels from `eye`.
  double apparent_size(std::size_t block, Vec3d eye) const;
  /// Marks the ancestors of a block as used by the current part.
  void mark_above(std::size_t block);
  /// Evicts all blocks but the root's.
  void evict_all();
  /// Evicts blocks of earlier parts until `block` fits. Returns whether it fits.
  bool make_room(std::size_t block);

  EsvoStream stream_;
  std::unique_ptr<std::atomic<bool>[]> wanted_;  ///< Per block.
  std::vector<std::uint64_t> loaded_in_;         ///< Per block: the last part that used it.
  std::uint64_t part_ = 1;
};

}  // namespace voxdag
