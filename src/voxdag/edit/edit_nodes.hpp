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
/// move. An unused run of words begins with one that is no child mask: kUnused + the run's length.
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "voxdag/core/page_vector.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/core/shared_number_table.hpp"
#include "voxdag/edit/base_numbers.hpp"
#include "voxdag/stored/svdag/edit_changes.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

class EditNodes {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFu;  ///< A cell without voxels.

  /// Copies `base`, which must be valid, and hashes its nodes on the current TBB arena. `work`
  /// counts both as long as this object lives. Throws OverMemory, Cancelled and std::bad_alloc.
  EditNodes(const SvdagView& base, Work work);
  EditNodes(const EditNodes&) = delete;
  EditNodes& operator=(const EditNodes&) = delete;

  int levels() const { return base_.levels; }
  /// Returns the root of the base; kNone if it has no voxels.
  std::uint32_t base_root() const { return base_.is_empty() ? kNone : 0; }
  /// Returns the base in this object's arrays.
  const SvdagView& base() const { return base_; }
  /// Returns whether no level of the base has two equal nodes.
  bool is_minimal() const;
  /// Returns the DAG with this root. Only functions that walk from the root may take it.
  SvdagView view(std::uint32_t root) const;

  const std::uint32_t* words(std::uint32_t node) const { return words_.data() + node; }
  std::uint64_t block(std::uint32_t node) const { return blocks_.data()[node]; }
  const std::uint64_t* address(std::uint32_t block) const { return blocks_.data() + block; }
  /// Returns child `index` of a node of a level below L-2; kNone if it has none or is kNone.
  std::uint32_t child(std::uint32_t node, int index) const {
    if (node == kNone || (child_mask(words(node)) >> index & 1) == 0) return kNone;
    return child_pointer(words(node), index);
  }

  /// Adds nodes. Each thread has its own, in whose run of memory its new nodes lie.
  class Writer;

  /// Returns the node of `level` that has all voxels. add_full() must have been called before.
  std::uint32_t full(int level) const { return full_[static_cast<std::size_t>(level)]; }
  /// Adds the nodes that have all voxels. Throws like Writer::intern().
  void add_full();

  /// The number of bytes of nodes behind the base, unused places included.
  std::uint64_t added_bytes() const {
    return (words_end_ - base_.node_words()) * 4 + (blocks_end_ - base_.leaf_block_count) * 8;
  }
  /// The number of bytes in unused places.
  std::uint64_t unused_bytes() const { return free_words_.count * 4 + free_blocks_.count * 8; }
  /// The number of nodes that were ever added.
  std::uint64_t added_nodes() const;
  /// One more than the last word or block that was ever written.
  std::uint64_t words_end() const { return words_end_; }
  std::uint64_t blocks_end() const { return blocks_end_; }

  /// Frees the places of all nodes behind the base that none of these roots reaches. Throws
  /// OverMemory, and then frees none.
  void collect(std::span<const std::uint32_t> roots);

  /// Makes this object note what is written from now on.
  void track_changes() { tracks_changes_ = true; }
  /// Returns what was written behind the base since the last call; nothing without track_changes().
  EditChanges take_changes() { return std::exchange(changes_, {}); }

 private:
  static constexpr std::uint32_t kUnused = 256;

  /// A run of words or blocks that one writer fills.
  struct Run {
    std::uint32_t next = 0, end = 0;
  };
  /// Unused runs. List i < 9 has those of i words or blocks, list 9 those of 9 and more.
  struct FreeRuns {
    std::array<std::vector<Run>, 10> lists;
    std::uint64_t count = 0;  ///< Words or blocks.

    void add(Run run);
    /// Takes a run of `least` to `most` words or blocks, or one of none. Sets `rest` to what is
    /// left of a longer one.
    Run take(std::uint32_t least, std::uint32_t most, Run& rest);
  };

  /// Gives a writer a run of at least `count` words, or of at least one block.
  void take_words(Run& run, std::uint32_t count);
  void take_blocks(Run& run);
  /// Writes the length of an unused run of words into it, and adds it to the list.
  void free_words(Run run);
  /// Takes back what is left of a run.
  void give_back_words(Run& run);
  void give_back_blocks(Run& run);
  void mark(int level, std::uint32_t node);
  bool is_marked(int level, std::uint32_t node) const;
  /// Counts memory up to these ends.
  void count_memory(std::uint64_t words_end, std::uint64_t blocks_end);

  Work work_;
  PageVector<std::uint32_t> words_;
  PageVector<std::uint64_t> blocks_;
  SvdagView base_;
  MemoryReservation memory_;
  std::mutex mutex_;  ///< Of the members up to changes_.
  std::uint64_t words_end_ = 0, blocks_end_ = 0;
  FreeRuns free_words_, free_blocks_;
  EditChanges changes_;
  bool tracks_changes_ = false;
  /// The base's nodes, and the others, of each level.
  std::vector<BaseNumbers> base_numbers_;
  std::vector<std::unique_ptr<SharedNumberTable>> tables_;
  std::uint64_t collected_nodes_ = 0;
  std::array<std::uint32_t, kMaxLevels> full_;
  std::vector<bool> word_marks_, block_marks_;  ///< Behind the base, during collect().
};

class EditNodes::Writer {
 public:
  explicit Writer(EditNodes& nodes) : nodes_(nodes) {}
  /// Gives the rest of its memory back.
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// A node to look up: its words, and their hash.
  struct Pending {
    std::uint32_t words[9];
    std::uint32_t count = 0;  ///< 0: a cell without voxels.
    std::uint64_t hash = 0;
  };
  /// Returns the words of a node with these children, kNone for one that is missing.
  static Pending node_of(const std::uint32_t (&children)[8]);
  /// Returns the words of a leaf block.
  static Pending block_of(std::uint64_t voxels);

  /// Starts loading what intern() reads first, and then what it reads next. A caller with many
  /// nodes calls each for all of them, so that loads overlap.
  void prefetch(int level, const Pending& node) const;
  void prefetch_found(int level, const Pending& node) const;
  /// Returns the node of `level`; adds it if it is new. kNone if it is without voxels. Throws Error
  /// if the nodes outgrow 32-bit pointers, and OverMemory.
  std::uint32_t intern(int level, const Pending& node);
  std::uint32_t intern(int level, const std::uint32_t (&children)[8]) {
    return intern(level, node_of(children));
  }
  std::uint32_t intern_block(std::uint64_t voxels) {
    return intern(nodes_.levels() - 2, block_of(voxels));
  }
  const EditNodes& nodes() const { return nodes_; }

 private:
  EditNodes& nodes_;
  Run words_, blocks_;
};

}  // namespace voxdag
