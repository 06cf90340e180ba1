#pragma once
/// The unique nodes of one level of a DAG under construction: hash-consing for many threads.
///
/// A node is a run of 32-bit words (child mask and the ids of its children, or the two words of a
/// leaf block). `intern` returns the same id for equal words in all threads. Each thread writes
/// words into runs of memory of its own, so that no lock is held while memory is allocated. The ids
/// depend on timing; canonical_order() makes the result independent of it.
///
///   id      | word offset (32 bits), the number in a slot (core/shared_number_table.hpp) |
#include <array>
#include <bit>
#include <cstdint>
#include <mutex>
#include <utility>

#include "voxdag/core/page_vector.hpp"
#include "voxdag/core/shared_number_table.hpp"

namespace voxdag {

using NodeId = std::uint32_t;
inline constexpr NodeId kNoNode = 0xFFFFFFFFu;

/// The words of a node that has no id yet. An empty cell has count 0.
struct PendingNode {
  std::uint32_t words[9];
  int count = 0;
  std::uint64_t hash;
};

class NodeStore {
 public:
  /// A run of a store's words that one thread fills.
  struct Run {
    std::uint32_t next = 0, end = 0;
  };

  explicit NodeStore(MemoryBudget& budget) : table_(&budget), budget_(&budget) {}
  ~NodeStore() { release(); }
  NodeStore(const NodeStore&) = delete;
  NodeStore& operator=(const NodeStore&) = delete;

  /// Returns the id of the node with these words; copies them to `run` if they are new. 1 <= count
  /// <= 9; `hash` is hash_words(words, count); `run` belongs to this store and thread. Throws Error
  /// if the level outgrows 32-bit ids, and OverMemory.
  NodeId intern(const std::uint32_t* words, int count, std::uint64_t hash, Run& run);

  /// Starts loading the slot that intern() of a node with this hash reads first.
  void prefetch(std::uint64_t hash) const { table_.prefetch(hash); }
  /// Starts loading the words that intern() compares next. Reads the slot, so call it when the load
  /// of prefetch() has had time to finish.
  void prefetch_found(std::uint64_t hash) const;

  /// Returns the words of a node; their address stays valid until release().
  std::uint32_t* words(NodeId id) {
    const int chunk = chunk_of(id);
    return chunks_[chunk].data() + (id - chunk_begin(chunk));
  }
  const std::uint32_t* words(NodeId id) const { return const_cast<NodeStore*>(this)->words(id); }

  /// Starts loading words(id); any number is allowed as id. No thread may add nodes at the same
  /// time.
  void prefetch_words(NodeId id) const {
    const int chunk = chunk_of(id);
    const auto address = reinterpret_cast<std::uintptr_t>(chunks_[chunk].data()) +
                         std::uintptr_t{4} * (id - chunk_begin(chunk));
    __builtin_prefetch(reinterpret_cast<const void*>(address));
  }
  /// Returns a number greater than every id.
  std::uint32_t end_id() const { return end_; }
  std::uint64_t node_count() const { return table_.count(); }
  std::uint64_t word_count() const { return table_.weight(); }

  /// Frees the slots; only words() and the counts may be called afterwards. Not thread-safe.
  void release_slots() { table_.release(); }
  /// Frees everything. Not thread-safe.
  void release();

 private:
  // Chunk i has kFirstChunk << i words, so that small levels take little and addresses stay fixed.
  // It is divided into eight runs, or into runs of 2^kMaxRunBits words.
  static constexpr int kFirstChunkBits = 9, kRunsBits = 3, kMaxRunBits = 17;
  static constexpr int kChunks = 32 - kFirstChunkBits + 1;

  static int chunk_of(std::uint32_t offset) {
    return std::bit_width((offset >> kFirstChunkBits) + 1) - 1;
  }
  static std::uint32_t chunk_begin(int chunk) { return ((1u << chunk) - 1) << kFirstChunkBits; }

  void take_run(Run& run);

  SharedNumberTable table_;
  std::array<PageVector<std::uint32_t>, kChunks> chunks_;
  MemoryBudget* budget_;
  std::mutex runs_mutex_;
  std::uint32_t end_ = 0;
  std::uint64_t word_bytes_ = 0;  // counted in the budget
};

}  // namespace voxdag
