#pragma once
/// Collects the nodes of a hash-consed build.
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "voxdag/builders/dag/node_store.hpp"
#include "voxdag/builders/dag/plane_memo.hpp"
#include "voxdag/core/memory_budget.hpp"

namespace voxdag {

/// Merges nodes as they are made. There is one store for each level 0..L-2, shared by all threads.
/// Each thread has its own plane memo and small cache of leaf blocks in front of the stores.
class DagSink {
 public:
  static constexpr bool kMemo = true;

  /// Allocates the memo. Throws OverMemory.
  DagSink(std::span<const std::unique_ptr<NodeStore>> stores, int log2_memo_sets,
          MemoryBudget& budget)
      : memory_(&budget, bytes(log2_memo_sets)),
        memo(log2_memo_sets),
        stores_(stores),
        runs_(stores.size()),
        leaf_cache_(PageVector<CachedLeaf>::zeros(std::size_t{1} << kCacheBits)) {}

  /// Returns the bytes that a sink takes.
  static constexpr std::uint64_t bytes(int log2_memo_sets) {
    return PlaneMemo::bytes(log2_memo_sets) + (sizeof(CachedLeaf) << kCacheBits);
  }

  /// Starts loading the memory that leaf() or node() will read; call it early.
  void prefetch(int level, PendingNode& pending) const {
    pending.hash = hash_words(pending.words, pending.count);
    stores_[level]->prefetch(pending.hash);
  }

  /// Continues prefetch(); call it when the loads of prefetch() have had time to finish.
  void prefetch_found(int level, const PendingNode& pending) const {
    stores_[level]->prefetch_found(pending.hash);
  }

  /// Sets `ids` to the ids of `count` <= 64 leaf blocks. Blocks are masks in Morton order, not 0.
  void leaves(const std::uint64_t* blocks, int count, NodeId* ids) {
    // Runs each step over all blocks, so that the waits for memory overlap.
    NodeStore& store = *stores_.back();
    std::uint64_t hashes[64];
    int missing[64], missing_count = 0;
    for (int i = 0; i < count; ++i) {
      const std::uint32_t words[2] = {static_cast<std::uint32_t>(blocks[i]),
                                      static_cast<std::uint32_t>(blocks[i] >> 32)};
      hashes[i] = hash_words(words, 2);
      const CachedLeaf& cached = leaf_cache_[hashes[i] >> (64 - kCacheBits)];
      if (cached.mask == blocks[i]) {
        ids[i] = cached.id;
        continue;
      }
      store.prefetch(hashes[i]);
      missing[missing_count++] = i;
    }
    for (int k = 0; k < missing_count; ++k) store.prefetch_found(hashes[missing[k]]);
    for (int k = 0; k < missing_count; ++k) {
      const int i = missing[k];
      const std::uint32_t words[2] = {static_cast<std::uint32_t>(blocks[i]),
                                      static_cast<std::uint32_t>(blocks[i] >> 32)};
      ids[i] = store.intern(words, 2, hashes[i], runs_.back());
      leaf_cache_[hashes[i] >> (64 - kCacheBits)] = {blocks[i], ids[i]};
    }
  }

  /// Returns the id of a leaf block: two words in Morton order, not both 0.
  NodeId leaf(const PendingNode& pending) {
    const std::uint64_t mask = pending.words[0] | static_cast<std::uint64_t>(pending.words[1])
                                                      << 32;
    CachedLeaf& cached = leaf_cache_[pending.hash >> (64 - kCacheBits)];
    if (cached.mask == mask) return cached.id;
    cached = {mask, stores_.back()->intern(pending.words, 2, pending.hash, runs_.back())};
    return cached.id;
  }
  /// Returns the id of a node: its child mask and the ids of the children, which are of level + 1.
  NodeId node(int level, const PendingNode& pending) {
    return stores_[level]->intern(pending.words, pending.count, pending.hash, runs_[level]);
  }

 private:
  static constexpr int kCacheBits = 15;
  struct CachedLeaf {
    std::uint64_t mask;  // 0: free
    NodeId id;
  };

  MemoryReservation memory_;

 public:
  PlaneMemo memo;

 private:
  std::span<const std::unique_ptr<NodeStore>> stores_;
  std::vector<NodeStore::Run> runs_;  // per level
  PageVector<CachedLeaf> leaf_cache_;
};

}  // namespace voxdag
