#pragma once
/// The DAG with 4³ cells to a node: what a ray crosses in one step takes two levels of the octree.
///
/// A wide node stands for a node of the octree together with its children. From the voxels up every
/// second level has wide nodes: levels L-2 (leaf blocks), L-4, ... down to 0, or to -1 where L is
/// odd: then the root lies above the grid, which is each of its eight octants (all the same, so
/// that it does not matter in which of them a walk starts). Everything is one array of 32-bit
/// words:
///
///   inner node   | mask, low word | mask, high word | pointer | ... |   2 + popcount(mask) words
///   leaf block   | mask, low word | mask, high word |
///   pointer      word index of the child, in the order of the bits of the mask
///   mask         bit x + 4y + 16z: the cell (x,y,z) of the node's 4³ is not empty
///
/// Made from the paper's layout when a file is loaded; it is never stored. About 1.2 times its
/// bytes.
#include <cstdint>
#include <vector>

#include "voxdag/layout/svdag.hpp"

namespace voxdag {

/// What kernels take: points into a WideSvdag, owns nothing.
struct WideSvdagView {
  const std::uint32_t* words = nullptr;
  std::uint64_t word_count = 0;
  std::uint32_t root = 0;   ///< Word index.
  int levels = kMinLevels;  ///< L

  VOXDAG_HD bool is_empty() const { return word_count == 0; }
  VOXDAG_HD std::uint64_t bytes() const { return word_count * 4; }
};

/// Owns a wide DAG in memory; the view is valid while the owner lives unchanged.
struct WideSvdag {
  int levels = kMinLevels;
  std::uint32_t root = 0;
  std::vector<std::uint32_t> words;

  WideSvdagView view() const { return {words.data(), words.size(), root, levels}; }
};

/// The same voxels in wide nodes. The DAG must be valid (see validate_svdag). One pass over it,
/// with up to half its bytes of memory beside the result. Throws Error if the result has 2^32
/// words.
WideSvdag make_wide_svdag(const SvdagView& dag);

/// The bit of cell `outer` (a child index) and in it `inner` in a wide node's mask.
VOXDAG_HD constexpr int wide_cell(int outer, int inner) {
  const int x = (outer & 1) << 1 | (inner & 1);
  const int y = (outer & 2) | (inner >> 1 & 1);
  const int z = (outer >> 1 & 2) | (inner >> 2 & 1);
  return x | y << 2 | z << 4;
}

}  // namespace voxdag
