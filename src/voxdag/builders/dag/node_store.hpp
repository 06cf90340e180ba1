#pragma once
/// The unique nodes of one level of a DAG under construction: hash-consing for many threads.
///
/// A node is a run of 32-bit words (child mask and the ids of its children, or the two words of a
/// leaf block). `intern` returns the same id for equal words in all threads. The table is split
/// into shards by hash. Threads find an existing node (the common case) without a lock; to add a
/// node they lock its shard. Each thread writes words into runs of memory of its own, so that no
/// lock is held while memory is allocated. The ids depend on timing; canonical_order() makes the
/// result independent of it.
///
///   id      | word offset (32 bits), the number in a slot (core/number_table.hpp) |
///   table   | address, log2 of the number of slots in its low 6 bits |
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "voxdag/core/number_table.hpp"
#include "voxdag/core/page_vector.hpp"

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

  explicit NodeStore(MemoryBudget& budget) : budget_(&budget) {}
  ~NodeStore() { release(); }
  NodeStore(const NodeStore&) = delete;
  NodeStore& operator=(const NodeStore&) = delete;

  /// Returns the id of the node with these words; copies them to `run` if they are new. 1 <= count
  /// <= 9; `hash` is hash_words(words, count); `run` belongs to this store and thread. Throws Error
  /// if the level outgrows 32-bit ids, and OverMemory.
  NodeId intern(const std::uint32_t* words, int count, std::uint64_t hash, Run& run);

  /// Starts loading the slot that intern() of a node with this hash reads first.
  void prefetch(std::uint64_t hash) const {
    const NumberSlots table = table_of(hash);
    if (table.slots != nullptr)
      __builtin_prefetch(table.slots + table.first_of(NumberSlots::tag_of(hash)));
  }
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
  std::uint64_t node_count() const;
  std::uint64_t word_count() const;

  /// Frees the slots; only words() may be called afterwards. Not thread-safe.
  void release_slots();
  /// Frees everything. Not thread-safe.
  void release();

 private:
  // Chunk i has kFirstChunk << i words, so that small levels take little and addresses stay fixed.
  // It is divided into eight runs, or into runs of 2^kMaxRunBits words.
  static constexpr int kFirstChunkBits = 9, kRunsBits = 3, kMaxRunBits = 17;
  static constexpr int kChunks = 32 - kFirstChunkBits + 1;
  static constexpr int kShardBits = 4, kShards = 1 << kShardBits;

  struct alignas(64) Shard {
    std::atomic_flag lock = ATOMIC_FLAG_INIT;
    bool growing = false;
    std::uint32_t node_count = 0;
    std::uint64_t word_count = 0;
    // Old tables keep their addresses until release_slots(), because another thread may be reading
    // them. Their memory is freed and reads as zeros: a lookup finds nothing there and continues in
    // the newest table.
    std::vector<PageVector<std::uint64_t>> tables;
  };

  static int chunk_of(std::uint32_t offset) {
    return std::bit_width((offset >> kFirstChunkBits) + 1) - 1;
  }
  static std::uint32_t chunk_begin(int chunk) { return ((1u << chunk) - 1) << kFirstChunkBits; }

  static std::uint32_t shard_of(std::uint64_t hash) {
    return static_cast<std::uint32_t>(hash >> (64 - kShardBits));
  }

  /// Returns the table of the hash's shard; `slots` is null before the shard's first node.
  NumberSlots table_of(std::uint64_t hash) const {
    const std::uint64_t packed = tables_[shard_of(hash)].load(std::memory_order_acquire);
    return {reinterpret_cast<std::uint64_t*>(packed & ~std::uint64_t{63}),
            std::uint64_t{1} << (packed & 63)};
  }

  void take_run(Run& run);
  void grow(std::uint32_t shard_index);

  // Kept apart from the shards, because every lookup reads these while adding a node writes to the
  // shards.
  alignas(64) std::array<std::atomic<std::uint64_t>, kShards> tables_{};
  std::array<PageVector<std::uint32_t>, kChunks> chunks_;
  std::unique_ptr<Shard[]> shards_{new Shard[kShards]};
  MemoryBudget* budget_;
  std::mutex runs_mutex_;
  std::uint32_t end_ = 0;
  std::uint64_t word_bytes_ = 0;  // counted in the budget
};

}  // namespace voxdag
