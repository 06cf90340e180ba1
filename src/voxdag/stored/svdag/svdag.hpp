#pragma once
/// The sparse voxel DAG in the layout of its paper.
///
/// Source: Kämpe, Sintorn and Assarsson, "High Resolution Sparse Voxel DAGs", SIGGRAPH 2013,
/// Figure 3.
///
/// A grid of N³ voxels, N = 2^L, has nodes of level 0 (the root) to L-1. Levels 0..L-3 are stored
/// as 32-bit words: a word with the 8-bit child mask, then one pointer for each child present, in
/// the order of the child index (x=1, y=2, z=4). A node of level L-2 is a leaf block, the 64-bit
/// mask of its 4³ voxels in Morton order: byte i is the child mask of its child i, of level L-1.
///
///   nodes        | level 0 | level 1 | ... | level L-3 |       32-bit words
///   leaf_blocks  | level L-2 |                                  64-bit masks
///
///   node         | mask (8 of 32 bits) | pointer | ... |       1 + popcount(mask) words
///   pointer      of level < L-3: word index in `nodes`; of level L-3: index in `leaf_blocks`
///
/// Canonical order: a depth-first walk from the root visits children in Morton order. The nodes of
/// each level are stored in the order in which this walk first meets them. No two nodes of a level
/// are equal, no node is empty and every node can be reached: the DAG is minimal, and its words
/// depend on the voxel set alone. A DAG without voxels has no nodes at all.
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "voxdag/core/bits.hpp"
#include "voxdag/core/grid.hpp"

namespace voxdag {

/// A view for kernels and readers: points into an Svdag or the bytes of a file and owns nothing.
struct SvdagView {
  const std::uint32_t* nodes = nullptr;
  const std::uint64_t* leaf_blocks = nullptr;
  std::uint64_t leaf_block_count = 0;
  /// The words of level l < L-2 are nodes[level_begin[l]] up to nodes[level_begin[l + 1] - 1]. The
  /// entries from L-2 on all hold the number of words in `nodes`.
  std::uint64_t level_begin[kMaxLevels + 1] = {};
  int levels = kMinLevels;  ///< L
  /// The root: a word index, or the leaf block if L is 2. 0 in canonical order. A DAG that is being
  /// edited (edit/editable_dag.hpp) has its root elsewhere, and nodes beyond the last level; then
  /// only functions that walk down from the root may take the view.
  std::uint32_t root = 0;

  VOXDAG_HD std::uint64_t node_words() const { return level_begin[levels - 2]; }
  VOXDAG_HD bool is_empty() const { return leaf_block_count == 0; }
  /// Returns the bytes of the paper's layout: 4 + 4 per child for inner nodes, 8 per leaf block.
  VOXDAG_HD std::uint64_t bytes() const { return node_words() * 4 + leaf_block_count * 8; }
};

/// A DAG in memory. The view is valid while this object lives unchanged.
struct Svdag {
  int levels = kMinLevels;
  std::vector<std::uint32_t> nodes;
  std::vector<std::uint64_t> leaf_blocks;
  std::array<std::uint64_t, kMaxLevels + 1> level_begin{};

  SvdagView view() const {
    SvdagView v;
    v.nodes = nodes.data();
    v.leaf_blocks = leaf_blocks.data();
    v.leaf_block_count = leaf_blocks.size();
    for (std::size_t i = 0; i < level_begin.size(); ++i) v.level_begin[i] = level_begin[i];
    v.levels = levels;
    return v;
  }
  friend bool operator==(const Svdag&, const Svdag&) = default;
};

/// Returns the 8-bit child mask of a node above the leaf blocks.
VOXDAG_HD inline std::uint32_t child_mask(const std::uint32_t* node) { return node[0] & 0xFFu; }

/// Returns the number of words of a node above the leaf blocks.
VOXDAG_HD inline int words_of_node(const std::uint32_t* node) {
  return 1 + popcount8(child_mask(node));
}

/// Returns the pointer to child `index`, which must be present.
VOXDAG_HD inline std::uint32_t child_pointer(const std::uint32_t* node, int index) {
  return node[1 + popcount8(node[0] & ((1u << index) - 1u))];
}

/// Returns the child mask of a leaf block: bit i is set if octant i has voxels.
VOXDAG_HD inline std::uint32_t leaf_block_child_mask(std::uint64_t block) {
  block |= block >> 4;
  block |= block >> 2;
  block |= block >> 1;
  block &= 0x0101010101010101ull;
  return static_cast<std::uint32_t>(block * 0x0102040810204080ull >> 56);
}

/// Returns the coordinate, 0 to 3, of bit `voxel` of a leaf block.
constexpr int leaf_coordinate(int voxel, int axis) {
  return (voxel >> (3 + axis) & 1) << 1 | (voxel >> axis & 1);
}
/// Returns the bits that a coordinate, 0 to 3, sets in the number of a voxel.
constexpr int leaf_bits(int coordinate, int axis) {
  return (coordinate >> 1) << (3 + axis) | (coordinate & 1) << axis;
}

}  // namespace voxdag
