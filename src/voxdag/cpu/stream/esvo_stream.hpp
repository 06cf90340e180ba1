#pragma once
/// An ESVO file with only some of its blocks in memory.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 3. All references
/// in a block are relative, so blocks can be moved: this makes the "dynamic memory management
/// necessary for out-of-core rendering" easy.
///
/// While a block is not loaded, the descriptor that leads to it is cut
/// (stored/esvo/partial_esvo.hpp). So the octree is complete at any time, but coarser where blocks
/// are missing: its leaves there contain all voxels of the missing blocks.
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <vector>

#include "voxdag/core/error_place.hpp"
#include "voxdag/core/io/open_input.hpp"
#include "voxdag/file/esvo_metadata.hpp"
#include "voxdag/stored/esvo/esvo.hpp"
#include "voxdag/stored/esvo/esvo_directory.hpp"
#include "voxdag/stored/esvo/partial_esvo.hpp"

namespace voxdag {

struct EsvoStreamCounts {
  std::uint64_t blocks_loaded = 0;  ///< Now in memory.
  std::uint64_t bytes_loaded = 0;   ///< Now in memory.
  std::uint64_t blocks_used = 0;    ///< Distinct blocks read since the file was opened.
  std::uint64_t blocks_read = 0;    ///< Reads since the file was opened, with repeated ones.
  std::uint64_t bytes_read = 0;
  std::uint64_t blocks_evicted = 0;
};

/// Not copyable or movable. Many threads may read through view() while no thread loads or evicts.
/// Every block is copied into memory and checked before rays can reach it, so later changes to the
/// file are harmless. Throws Error(path, place, reason).
class EsvoStream {
 public:
  /// Reads the directory and loads the root's block. `memory` limits the bytes of the loaded
  /// blocks. Throws Error if any block with its ancestors needs more, and for a DAG.
  EsvoStream(const std::filesystem::path& path, std::uint64_t memory);
  EsvoStream(const EsvoStream&) = delete;
  EsvoStream& operator=(const EsvoStream&) = delete;

  const EsvoMetadata& metadata() const { return metadata_; }
  const Grid& grid() const { return metadata_.grid; }
  std::span<const EsvoBlockEntry> directory() const { return directory_; }
  const EsvoStreamCounts& counts() const { return counts_; }

  /// Returns the loaded octree, which load() and evict() change.
  EsvoView view() const { return {pool_.data(), pool_.size(), root_, metadata_.grid.levels}; }
  /// Returns it with the marks of its cut descriptors.
  PartialEsvoView loaded() const { return {view(), cut_.data()}; }

  /// Returns a number that grows with every load() and evict().
  std::uint64_t version() const { return version_; }
  /// Returns the slots of the loaded blocks that have changed, or whose marks have, since version()
  /// was `version`; 0: of all loaded blocks. Copies of the pool need no other slots.
  std::vector<SlotRange> changes_since(std::uint64_t version) const;

  bool is_loaded(std::size_t block) const { return blocks_[block].position != kNowhere; }
  /// Returns the parent block, or -1.
  std::int64_t parent(std::size_t block) const { return blocks_[block].parent; }
  /// Returns whether the block's parent is loaded, which load() requires.
  bool can_load(std::size_t block) const;
  /// Returns whether the block fits into memory with the loaded ones.
  bool has_room(std::size_t block) const;

  /// Reads a block and attaches it to the octree. can_load() and has_room() must be true.
  void load(std::size_t block);
  /// Removes a loaded block. It must not be the root's, and none of its child blocks may be loaded.
  void evict(std::size_t block);
  /// Returns whether evict() may remove the block.
  bool can_evict(std::size_t block) const;

 private:
  static constexpr std::uint64_t kNowhere = ~std::uint64_t{0};

  struct Block {
    std::uint64_t position = kNowhere;  ///< First slot in the pool.
    std::int64_t parent = -1;           ///< Index of the parent block.
    std::uint32_t parent_slot =
        0;  ///< The parent descriptor, counted from the parent block's begin.
    std::uint32_t loaded_children = 0;
    bool was_loaded = false;
    std::uint64_t version = 0;  ///< The version in which its slots or their marks changed last.
    std::vector<std::uint32_t> children;
    std::vector<Vec3i> siblings;   ///< Cells of the first group, known once the parent is loaded.
    std::uint32_t descriptor = 0;  ///< The children word of the parent descriptor, as in the file.
  };

  [[noreturn]] void fail(ErrorPlace place, const std::string& reason) const;
  void read(std::uint64_t offset, void* data, std::size_t bytes) const;
  void find_children();
  std::uint64_t most_slots_of_a_path() const;
  std::uint64_t allocate(std::uint32_t slots);
  void release(std::uint64_t position, std::uint32_t slots);
  void cut(std::size_t block);
  void attach(std::size_t block, std::uint32_t first_descriptor);
  void mark(std::uint64_t slot, bool is_cut);

  std::filesystem::path path_;
  OpenInput file_;
  std::uint64_t slots_offset_ = 0;  ///< Byte of the ESVO chunk in the file.
  EsvoMetadata metadata_;
  std::vector<EsvoBlockEntry> directory_;
  std::vector<Block> blocks_;
  std::vector<std::uint64_t> pool_;
  std::map<std::uint64_t, std::uint64_t> free_;  ///< Begin and length of the free ranges, in slots.
  std::uint64_t root_ = 0;
  std::vector<std::uint32_t> cut_;  ///< As PartialEsvoView::cut.
  std::uint64_t version_ = 0;
  EsvoStreamCounts counts_;
};

}  // namespace voxdag
