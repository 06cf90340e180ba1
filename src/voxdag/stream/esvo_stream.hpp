#pragma once
/// An ESVO file of which only some blocks are in memory.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 3: all references
/// in a block are relative, so that blocks can be moved about and "dynamic memory management
/// necessary for out-of-core rendering" is easy.
///
/// While a block is not loaded, the descriptor that leads to it says that its children are leaves:
/// the octree is whole at any time, coarser where blocks are missing, and its voxels there contain
/// what the missing blocks hold.
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <unordered_map>
#include <vector>

#include "voxdag/file/esvo_metadata.hpp"
#include "voxdag/layout/esvo.hpp"
#include "voxdag/layout/esvo_directory.hpp"

namespace voxdag {

struct EsvoStreamCounts {
  std::uint64_t blocks_loaded = 0;  ///< Now in memory.
  std::uint64_t bytes_loaded = 0;   ///< Likewise.
  std::uint64_t blocks_used = 0;    ///< Different ones, since the file was opened.
  std::uint64_t blocks_read = 0;    ///< Likewise, those read again included.
  std::uint64_t bytes_read = 0;
  std::uint64_t blocks_evicted = 0;
};

/// Neither copied nor moved. Reading through view() may go on in many threads while nobody loads or
/// evicts. Every block is checked before it can be walked; errors are Error(path, place, reason).
class EsvoStream {
 public:
  /// Reads the directory and loads the root's block. `memory` is what blocks may take, in bytes;
  /// throws if any block and those above it take more.
  EsvoStream(const std::filesystem::path& path, std::uint64_t memory);
  ~EsvoStream();
  EsvoStream(const EsvoStream&) = delete;
  EsvoStream& operator=(const EsvoStream&) = delete;

  const EsvoMetadata& metadata() const { return metadata_; }
  const Grid& grid() const { return metadata_.grid; }
  std::span<const EsvoBlockEntry> directory() const { return directory_; }
  const EsvoStreamCounts& counts() const { return counts_; }

  /// Of what is loaded: changes with load() and evict().
  EsvoView view() const { return {pool_.data(), pool_.size(), root_, metadata_.grid.levels}; }

  /// The block that is missing below the descriptor in `slot` of view(), or -1. Thread-safe.
  std::int64_t missing_block(std::uint64_t slot) const {
    if (!is_cut_[slot]) return -1;
    return cut_.find(slot)->second;
  }

  bool is_loaded(std::size_t block) const { return blocks_[block].position != kNowhere; }
  /// The block above, or -1.
  std::int64_t parent(std::size_t block) const { return blocks_[block].parent; }
  /// Whether the block above it is loaded, so that it can be.
  bool can_load(std::size_t block) const;
  /// Whether it fits beside what is loaded.
  bool has_room(std::size_t block) const;

  /// Reads a block whose parent is loaded, and hangs it into the octree. It must have room.
  void load(std::size_t block);
  /// Takes a loaded block out. It must not be the root's, and no block below it may be loaded.
  void evict(std::size_t block);
  /// Whether evict() may take it.
  bool can_evict(std::size_t block) const;

 private:
  static constexpr std::uint64_t kNowhere = ~std::uint64_t{0};

  struct Block {
    std::uint64_t position = kNowhere;  ///< Its first slot in the pool.
    std::int64_t parent = -1;           ///< Block.
    std::uint32_t parent_slot = 0;      ///< Of the descriptor, from the parent block's begin.
    std::uint32_t loaded_children = 0;
    bool was_loaded = false;
    std::vector<std::uint32_t> children;
    std::vector<Vec3i> siblings;   ///< Cells of its first group, known once the parent is loaded.
    std::uint32_t descriptor = 0;  ///< The children word of the descriptor above, as in the file.
  };

  [[noreturn]] void fail(ErrorPlace place, const std::string& reason) const;
  void read(std::uint64_t offset, void* data, std::size_t bytes) const;
  void find_children();
  std::uint64_t most_slots_of_a_path() const;
  std::uint64_t allocate(std::uint32_t slots);
  void release(std::uint64_t position, std::uint32_t slots);
  void cut(std::size_t block);
  void hang(std::size_t block, std::uint32_t first_descriptor);

  std::filesystem::path path_;
  int file_ = -1;
  std::uint64_t slots_offset_ = 0;  ///< Of the ESVO chunk in the file.
  EsvoMetadata metadata_;
  std::vector<EsvoBlockEntry> directory_;
  std::vector<Block> blocks_;
  std::vector<std::uint64_t> pool_;
  std::map<std::uint64_t, std::uint64_t> free_;  ///< Begin and length of what is free, in slots.
  std::uint64_t root_ = 0;
  std::vector<bool> is_cut_;  ///< By slot of the pool: a descriptor with a missing block below.
  std::unordered_map<std::uint64_t, std::int64_t> cut_;
  EsvoStreamCounts counts_;
};

}  // namespace voxdag
