#pragma once
/// The unique nodes of one level of a DAG under construction: hash-consing for many threads.
///
/// A node is a run of 32-bit words (child mask and the ids of its children, or the two words of a
/// leaf block). `intern` returns the same id for equal words, whichever thread asks. The table is
/// split into shards by hash. A node that is there already, the common case, is found without a
/// lock; only adding one takes its shard's. The ids depend on timing; canonical_order() makes the
/// result independent of it.
///
///   id      | shard (4 bits) | word offset in the shard (28 bits) |
///   slot    | 32 bits of hash | 1 | word offset (28 of 31 bits) |    0 = free; linear probing
///   table   | index of the last slot | 7 words unused | slots ... |
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "voxdag/core/int128.hpp"
#include "voxdag/dag/memory_budget.hpp"
#include "voxdag/dag/page_array.hpp"

namespace voxdag {

using NodeId = std::uint32_t;
inline constexpr NodeId kNoNode = 0xFFFFFFFFu;

/// A hash of a node's words: 64-bit multiply and fold.
inline std::uint64_t hash_words(const std::uint32_t* words, int count) {
  std::uint64_t h = 0x9E3779B97F4A7C15ull ^ static_cast<std::uint64_t>(count);
  for (int i = 0; i < count; i += 2) {
    const std::uint64_t pair =
        words[i] | (i + 1 < count ? static_cast<std::uint64_t>(words[i + 1]) << 32 : 0);
    const Uint128 product = static_cast<Uint128>(h ^ pair) * 0xD6E8FEB86659FD93ull;
    h = static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64);
  }
  return h ^ (h >> 32);
}

class NodeStore {
 public:
  explicit NodeStore(MemoryBudget& budget) : budget_(&budget) {}
  ~NodeStore() { release(); }
  NodeStore(const NodeStore&) = delete;
  NodeStore& operator=(const NodeStore&) = delete;

  /// The id of the node with these words; copies them if they are new. 1 <= count <= 9. Throws
  /// Error if the level outgrows 32-bit ids.
  NodeId intern(const std::uint32_t* words, int count) {
    return intern(words, count, hash_words(words, count));
  }
  /// The same for words whose hash the caller has.
  NodeId intern(const std::uint32_t* words, int count, std::uint64_t hash);

  /// Starts loading what intern() of a node with this hash will look at first.
  void prefetch(std::uint64_t hash) const {
    const Shard& shard = shards_[shard_of(hash)];
    const std::uint64_t* table = shard.table.load(std::memory_order_acquire);
    if (table != nullptr) __builtin_prefetch(table + kTableHeader + (tag_of(hash) & table[0]));
  }

  /// The words of a node; they stay where they are until release().
  std::uint32_t* words(NodeId id) { return shards_[id >> kOffsetBits].at(id & kOffsetMask); }

  /// Starts loading words(id); harmless for any number.
  void prefetch_words(NodeId id) const {
    const Shard& shard = shards_[id >> kOffsetBits];
    const std::uint32_t offset = id & kOffsetMask;
    const int chunk = Shard::chunk_of(offset);
    const auto address = reinterpret_cast<std::uintptr_t>(shard.chunks[chunk].data()) +
                         std::uintptr_t{4} * (offset - Shard::chunk_begin(chunk));
    __builtin_prefetch(reinterpret_cast<const void*>(address));
  }
  /// Offset after the last word of a shard.
  std::uint32_t used_words(int shard) const { return shards_[shard].used_words; }
  std::uint64_t node_count() const;
  std::uint64_t word_count() const;

  /// Frees the slots; after it only words() may be called. Not thread-safe.
  void release_slots();
  /// Frees everything. Not thread-safe.
  void release();

  static constexpr int kOffsetBits = 28;
  static constexpr std::uint32_t kOffsetMask = (1u << kOffsetBits) - 1;
  static constexpr int kShards = 1 << (32 - kOffsetBits);

 private:
  // Chunk i has kFirstChunk << i words, so that small levels take little and addresses stay fixed.
  static constexpr int kFirstChunkBits = 9;
  static constexpr int kChunks = kOffsetBits - kFirstChunkBits + 1;

  static constexpr std::size_t kTableHeader = 8;

  struct alignas(64) Shard {
    std::atomic<std::uint64_t*> table{nullptr};  // the last of `tables`
    std::atomic_flag lock = ATOMIC_FLAG_INIT;
    std::uint32_t used_words = 0;    // offset of the next word
    std::uint32_t stored_words = 0;  // words of nodes, without what chunk ends waste
    std::uint32_t node_count = 0;
    // Outgrown tables stay until release_slots(): another thread may be reading them.
    std::vector<PageArray<std::uint64_t>> tables;
    std::array<PageArray<std::uint32_t>, kChunks> chunks;

    static int chunk_of(std::uint32_t offset) {
      return std::bit_width((offset >> kFirstChunkBits) + 1) - 1;
    }
    static std::uint32_t chunk_begin(int chunk) { return ((1u << chunk) - 1) << kFirstChunkBits; }
    std::uint32_t* at(std::uint32_t offset) {
      const int chunk = chunk_of(offset);
      return chunks[chunk].data() + (offset - chunk_begin(chunk));
    }
  };

  static std::uint32_t shard_of(std::uint64_t hash) {
    return static_cast<std::uint32_t>(hash >> (64 - (32 - kOffsetBits)));
  }
  static std::uint32_t tag_of(std::uint64_t hash) { return static_cast<std::uint32_t>(hash); }

  /// The slot where the words are or would be.
  std::uint64_t* find(Shard& shard, std::uint64_t* table, std::uint32_t tag,
                      const std::uint32_t* words, int count, std::uint64_t& slot);
  std::uint32_t append(Shard& shard, const std::uint32_t* words, int count);
  std::uint64_t* grow(Shard& shard);

  MemoryBudget* budget_;
  std::unique_ptr<Shard[]> shards_{new Shard[kShards]};
};

}  // namespace voxdag
