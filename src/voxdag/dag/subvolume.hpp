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

/// Where a hash-consed build puts its nodes: one store for each level 0..L-2, shared by all
/// threads, behind a small cache of leaf blocks of this thread's own.
class DagSink {
 public:
  static constexpr bool kMemo = true;

  DagSink(std::span<const std::unique_ptr<NodeStore>> stores, int log2_memo_sets)
      : memo(log2_memo_sets), stores_(stores), leaf_cache_(std::size_t{1} << kCacheBits) {}

  /// `mask` in Morton order, not 0.
  NodeId leaf(std::uint64_t mask) {
    const std::uint64_t h = mask * 0x9E3779B97F4A7C15ull;
    CachedLeaf& cached = leaf_cache_[h >> (64 - kCacheBits)];
    if (cached.mask == mask) return cached.id;
    const std::uint32_t words[2] = {static_cast<std::uint32_t>(mask),
                                    static_cast<std::uint32_t>(mask >> 32)};
    cached = {mask, stores_.back()->intern(words, 2)};
    return cached.id;
  }
  /// `words`: child mask and the ids of the children, which are of level + 1.
  NodeId node(int level, const std::uint32_t* words, int count) {
    return stores_[level]->intern(words, count);
  }

  PlaneMemo memo;

 private:
  static constexpr int kCacheBits = 13;
  struct CachedLeaf {
    std::uint64_t mask;  // 0: free
    NodeId id;
  };

  std::span<const std::unique_ptr<NodeStore>> stores_;
  PageArray<CachedLeaf> leaf_cache_;
};

/// Where the paper's method puts them: an explicit octree, nothing merged. Ids are indices.
class TreeSink {
 public:
  static constexpr bool kMemo = false;

  explicit TreeSink(int levels) : nodes(levels - 2) {}

  NodeId leaf(std::uint64_t mask) {
    leaves.push_back(mask);
    return static_cast<NodeId>(leaves.size() - 1);
  }
  NodeId node(int level, const std::uint32_t* words, int) {
    SortNode& node = nodes[level].emplace_back();
    node.fill(kNoNode);
    const std::uint32_t* child = words + 1;
    for (std::uint32_t left = words[0]; left != 0; left &= left - 1)
      node[std::countr_zero(left)] = *child++;
    return static_cast<NodeId>(nodes[level].size() - 1);
  }

  std::vector<std::uint64_t> leaves;         ///< Leaf blocks, in Morton order of the cells.
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
    std::uint32_t triangle, alive;
    std::uint64_t lanes[2];
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
