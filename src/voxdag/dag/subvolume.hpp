#pragma once
/// Builds one cell of the octree, depth first, from the triangles that meet it.
#include <bit>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "voxdag/dag/node_store.hpp"
#include "voxdag/dag/plane_memo.hpp"
#include "voxdag/dag/sort_reduce.hpp"
#include "voxdag/voxelize/grid_mapping.hpp"
#include "voxdag/voxelize/triangle_setup.hpp"

namespace voxdag {

/// A cell of 2^log2_size voxels a side (at least 4) and the indices of the triangles that may meet
/// it.
struct SubvolumeJob {
  Vec3i origin;  ///< First voxel.
  int log2_size;
  std::span<const std::uint32_t> triangles;
};

/// The words of a node that has no id yet; count 0 is an empty cell.
struct PendingNode {
  std::uint32_t words[9];
  int count = 0;
  std::uint64_t hash;
};

/// Where a hash-consed build puts its nodes: one store for each level 0..L-2, shared by all
/// threads, behind a small cache of leaf blocks of this thread's own.
class DagSink {
 public:
  static constexpr bool kMemo = true;

  DagSink(std::span<const std::unique_ptr<NodeStore>> stores, int log2_memo_sets)
      : memo(log2_memo_sets),
        stores_(stores),
        runs_(stores.size()),
        leaf_cache_(std::size_t{1} << kCacheBits) {}

  /// A node on its way to its store: `prefetch` early, `leaf` or `node` some time later.
  void prefetch(int level, PendingNode& pending) const {
    pending.hash = hash_words(pending.words, pending.count);
    stores_[level]->prefetch(pending.hash);
  }

  /// In between, when what was asked for first has arrived.
  void prefetch_found(int level, const PendingNode& pending) const {
    stores_[level]->prefetch_found(pending.hash);
  }

  /// The ids of `count` leaf blocks, at most 64, in Morton order, none of them 0.
  void leaves(const std::uint64_t* blocks, int count, NodeId* ids) {
    // Each step over all blocks at once, so that the waits for memory overlap.
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

  /// The two words of a leaf block in Morton order, not 0.
  NodeId leaf(const PendingNode& pending) {
    const std::uint64_t mask = pending.words[0] | static_cast<std::uint64_t>(pending.words[1])
                                                      << 32;
    CachedLeaf& cached = leaf_cache_[pending.hash >> (64 - kCacheBits)];
    if (cached.mask == mask) return cached.id;
    cached = {mask, stores_.back()->intern(pending.words, 2, pending.hash, runs_.back())};
    return cached.id;
  }
  /// Child mask and the ids of the children, which are of level + 1.
  NodeId node(int level, const PendingNode& pending) {
    return stores_[level]->intern(pending.words, pending.count, pending.hash, runs_[level]);
  }

  PlaneMemo memo;

 private:
  static constexpr int kCacheBits = 15;
  struct CachedLeaf {
    std::uint64_t mask;  // 0: free
    NodeId id;
  };

  std::span<const std::unique_ptr<NodeStore>> stores_;
  std::vector<NodeStore::Run> runs_;  // by level
  PageArray<CachedLeaf> leaf_cache_;
};

/// Where the paper's method puts them: an explicit octree, nothing merged. Ids are indices.
class TreeSink {
 public:
  static constexpr bool kMemo = false;

  explicit TreeSink(int levels) : nodes(levels - 2) {}

  void prefetch(int, const PendingNode&) const {}
  void prefetch_found(int, const PendingNode&) const {}

  void leaves(const std::uint64_t* blocks, int count, NodeId* ids) {
    for (int i = 0; i < count; ++i) {
      ids[i] = static_cast<NodeId>(leaf_blocks.size());
      leaf_blocks.push_back(blocks[i]);
    }
  }
  NodeId leaf(const PendingNode& pending) {
    leaf_blocks.push_back(pending.words[0] | static_cast<std::uint64_t>(pending.words[1]) << 32);
    return static_cast<NodeId>(leaf_blocks.size() - 1);
  }
  NodeId node(int level, const PendingNode& pending) {
    SortNode& node = nodes[level].emplace_back();
    node.fill(kNoNode);
    const std::uint32_t* child = pending.words + 1;
    for (std::uint32_t left = pending.words[0]; left != 0; left &= left - 1)
      node[std::countr_zero(left)] = *child++;
    return static_cast<NodeId>(nodes[level].size() - 1);
  }

  std::vector<std::uint64_t> leaf_blocks;    ///< Leaf blocks, in Morton order of the cells.
  std::vector<std::vector<SortNode>> nodes;  ///< By level.
};

/// What one thread needs to build cells; reused from job to job.
template <class Sink>
struct SubvolumeContext {
  struct Item {
    std::uint32_t triangle;    // index in setups
    std::uint32_t conditions;  // what can still fail in the cell in hand
  };
  struct Classified {
    std::uint32_t triangle, conditions;
    std::uint64_t met;  // grandchildren, in Morton order
  };

  SubvolumeContext(const QuantizedMesh& mesh_in, int levels_in, Sink sink_in)
      : mesh(&mesh_in), levels(levels_in), sink(std::move(sink_in)) {}

  const QuantizedMesh* mesh;
  int levels;
  Sink sink;
  std::vector<TriangleSetup> setups;
  std::vector<Item> items;             // stack of lists
  std::vector<Classified> classified;  // stack of lists
};

/// The id of the cell's node (of level L - log2_size), or kNoNode if the cell is empty.
NodeId build_subvolume(SubvolumeContext<DagSink>& context, const SubvolumeJob& job);
NodeId build_subvolume(SubvolumeContext<TreeSink>& context, const SubvolumeJob& job);

}  // namespace voxdag
