#pragma once
/// The nodes of a DAG that grows: those of a base DAG, and behind them those that edits add.
///
///   nodes        | words of the base, as stored | words of new nodes, of all levels ->
///   leaf_blocks  | blocks of the base           | new blocks ->
///
/// Both arrays have a fixed address, so readers keep walking from their roots while nodes are
/// added. Nodes are hash-consed: a level has no two equal nodes, in the base and behind it.
///
/// collect() marks what is reachable, and later nodes take the places of the others. Nodes never
/// move. An unused place begins with a word that is no child mask: kUnused + its number of words.
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "voxdag/core/number_table.hpp"
#include "voxdag/core/page_vector.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// A run of words or of leaf blocks.
struct EditRun {
  std::uint64_t first = 0, count = 0;
};

/// Extends the last run if it ends where the new one begins, else appends the new one.
inline void note_run(std::vector<EditRun>& runs, std::uint64_t first, std::uint64_t count) {
  if (!runs.empty() && runs.back().first + runs.back().count == first)
    runs.back().count += count;
  else
    runs.push_back({first, count});
}

/// What was written since somebody last asked: runs, in the order of writing.
struct EditChanges {
  std::vector<EditRun> words, blocks;
};

class EditNodes {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFu;  ///< A cell without voxels.

  /// Copies `base`, which must be valid, and hashes its nodes on the current TBB arena. `work`
  /// counts both as long as this object lives. Throws OverMemory, Cancelled and std::bad_alloc.
  EditNodes(const SvdagView& base, Work work);
  EditNodes(const EditNodes&) = delete;
  EditNodes& operator=(const EditNodes&) = delete;
  ~EditNodes();

  int levels() const { return base_.levels; }
  /// Returns the root of the base; kNone if it has no voxels.
  std::uint32_t base_root() const { return base_.is_empty() ? kNone : 0; }
  /// Returns the base in this object's arrays.
  const SvdagView& base() const { return base_; }
  /// Returns the DAG with this root. Only functions that walk from the root may take it.
  SvdagView view(std::uint32_t root) const;

  const std::uint32_t* words(std::uint32_t node) const { return words_.data() + node; }
  std::uint64_t block(std::uint32_t node) const { return blocks_.data()[node]; }
  const std::uint64_t* blocks(std::uint32_t first) const { return blocks_.data() + first; }
  /// Returns child `index` of a node of a level below L-2; kNone if it has none or is kNone.
  std::uint32_t child(std::uint32_t node, int index) const {
    if (node == kNone || (child_mask(words(node)) >> index & 1) == 0) return kNone;
    return child_pointer(words(node), index);
  }

  /// Returns the node of `level`, below L-2, with these children, kNone for one that is missing;
  /// kNone if all are missing. Throws Error if the nodes outgrow 32-bit pointers, and OverMemory.
  std::uint32_t intern(int level, const std::uint32_t (&children)[8]);
  /// Returns the leaf block of these voxels; kNone if there are none. Throws like intern().
  std::uint32_t intern_block(std::uint64_t voxels);
  /// Returns the node of `level` that has all voxels.
  std::uint32_t full(int level);

  /// The number of bytes of nodes behind the base, unused places included.
  std::uint64_t added_bytes() const {
    return (words_end_ - base_.node_words()) * 4 + (blocks_end_ - base_.leaf_block_count) * 8;
  }
  /// The number of bytes in unused places.
  std::uint64_t unused_bytes() const { return unused_words_ * 4 + free_blocks_.size() * 8; }
  /// The number of nodes that were ever added.
  std::uint64_t added_nodes() const { return added_nodes_; }
  /// One more than the last word or block that was ever written.
  std::uint64_t words_end() const { return words_end_; }
  std::uint64_t blocks_end() const { return blocks_end_; }

  /// Frees the places of all nodes behind the base that none of these roots reaches. Throws
  /// OverMemory, and then frees none.
  void collect(std::span<const std::uint32_t> roots);

  /// Returns what was written behind the base since the last call.
  EditChanges take_changes() { return std::exchange(changes_, {}); }

 private:
  static constexpr std::uint32_t kUnused = 256;

  template <class IsEqual, class Add>
  std::uint32_t find_or_add(int level, std::uint64_t hash, const IsEqual& is_equal, const Add& add);
  std::uint32_t add_words(const std::uint32_t* words, std::uint32_t count);
  std::uint32_t add_block(std::uint64_t voxels);
  void hash_base(int level);
  void mark(int level, std::uint32_t node);
  bool is_marked(int level, std::uint32_t node) const;
  /// Counts memory up to these ends.
  void count_memory(std::uint64_t words_end, std::uint64_t blocks_end);

  Work work_;
  PageVector<std::uint32_t> words_;
  PageVector<std::uint64_t> blocks_;
  SvdagView base_;
  MemoryReservation memory_;
  std::uint64_t words_end_ = 0, blocks_end_ = 0, added_nodes_ = 0, unused_words_ = 0;
  /// The slots of the base's nodes, and a table of the others, for each level.
  std::vector<PageVector<std::uint64_t>> base_slots_;
  std::vector<NumberTable> tables_;
  std::array<std::uint32_t, kMaxLevels> full_;
  std::array<std::vector<std::uint32_t>, 10> free_words_;  ///< By number of words.
  std::vector<std::uint32_t> free_blocks_;
  std::vector<bool> word_marks_, block_marks_;  ///< Behind the base, during collect().
  EditChanges changes_;
};

}  // namespace voxdag
