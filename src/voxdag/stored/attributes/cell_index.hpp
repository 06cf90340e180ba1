#pragma once
/// The numbers of a DAG's cells, by which attributes are stored.
///
/// The cells are those of the octree that the DAG represents, from level 0 (the root) to level m,
/// the finest that has attributes. They are numbered in depth-first order: parents before children,
/// children in Morton order. The cells below a cell follow it, so
///
///   number(child) = number(node) + 1 + cells in the subtrees of the siblings before the child
///
/// Equal subtrees share a node but have different numbers.
///
/// The distances number(child) - number(node) are stored in slots beside the DAG's nodes. Level l
/// has slots if l + 1 < m and l < L-2: then each word of its nodes has a slot of width[l] bits.
///
///   node   | mask        | pointer 0 | pointer 1     | ... | pointer c-1   |
///   slot   | zero        | 1 + s(0)  | 1 + s(0)+s(1) | ... | 1 + all s     |
///
/// s(k) is the number of cells in the subtree of child k. The slot of pointer k - 1 is the distance
/// to child k; the distance to child 0 is 1. The last slot is the number of cells in the node's own
/// subtree. Other levels need no slots: children of level m have no cells below them, and the bits
/// of a leaf block tell the numbers of its cells.
///
///   words   | slots of level 0 | slots of level 1 | ...      each level begins at a word
#include <array>
#include <cstdint>
#include <vector>

#include "voxdag/core/bits.hpp"
#include "voxdag/stored/svdag/bit_words.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// A view for kernels and readers of the numbers of one DAG's cells.
struct CellIndexView {
  const std::uint64_t* words = nullptr;
  /// The slots of level l begin at words[begin[l]]; begin[l + 1] is their end.
  std::uint64_t begin[kMaxLevels + 1] = {};
  std::uint8_t width[kMaxLevels] = {};  ///< Bits of a slot of level l; 0: the level has none.
  std::uint8_t finest_level = 0;        ///< m
  std::uint64_t cells = 0;  ///< Number of cells of levels 0 to m; 0 for a DAG without voxels.

  VOXDAG_HD std::uint64_t word_count() const { return begin[kMaxLevels]; }
  VOXDAG_HD std::uint64_t bytes() const { return word_count() * 8; }
};

/// Numbers in memory. The view is valid while this object lives unchanged.
struct CellIndex {
  std::vector<std::uint64_t> words;
  std::array<std::uint8_t, kMaxLevels> width{};
  std::array<std::uint64_t, kMaxLevels + 1> begin{};
  std::uint8_t finest_level = 0;
  std::uint64_t cells = 0;

  CellIndexView view() const {
    CellIndexView v;
    v.words = words.data();
    for (std::size_t l = 0; l < begin.size(); ++l) v.begin[l] = begin[l];
    for (std::size_t l = 0; l < width.size(); ++l) v.width[l] = width[l];
    v.finest_level = finest_level;
    v.cells = cells;
    return v;
  }
  friend bool operator==(const CellIndex&, const CellIndex&) = default;
};

/// Returns whether the nodes of `level` have slots if `finest` is the finest level with attributes.
VOXDAG_HD constexpr bool has_cell_sums(const SvdagView& dag, int level, int finest) {
  return level + 1 < finest && level < dag.levels - 2;
}

/// Returns the slot beside word `word` of the DAG, which belongs to a node of `level`.
VOXDAG_HD inline std::uint64_t cell_sum(const SvdagView& dag, const CellIndexView& index, int level,
                                        std::uint64_t word) {
  const int width = index.width[level];
  return read_bits(index.words + index.begin[level],
                   (word - dag.level_begin[level]) * static_cast<std::uint64_t>(width), width);
}

/// Returns the number of cells in the subtree of a leaf block, itself included, in a DAG of
/// `levels`. `finest`, at least levels - 2, is the finest level with attributes.
VOXDAG_HD inline std::uint64_t leaf_block_cells(std::uint64_t block, int levels, int finest) {
  std::uint64_t cells = 1;
  if (finest > levels - 2)
    cells += static_cast<std::uint64_t>(popcount8(leaf_block_child_mask(block)));
  if (finest == levels) cells += static_cast<std::uint64_t>(popcount64(block));
  return cells;
}

/// Returns the distance from a leaf block's number to the number of its octant `child`, which must
/// have voxels.
VOXDAG_HD inline std::uint64_t octant_distance(std::uint64_t block, int child, int levels,
                                               int finest) {
  const std::uint64_t before = block & ((std::uint64_t{1} << (8 * child)) - 1);
  return leaf_block_cells(before, levels, finest);
}

}  // namespace voxdag
