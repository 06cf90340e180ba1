#pragma once
/// The wide DAG: 4³ cells per node, so that one step of a ray covers two levels of the octree.
///
/// A wide node represents a node of the octree together with its children. Every second level has
/// wide nodes: L-2 (leaf blocks), L-4 and so on up to level 0, or level -1 if L is odd. A root of
/// level -1 lies one level above the grid. Each of its eight octants is a copy of the grid, so a
/// walk may start in any of them. Everything is one array of 32-bit words:
///
///   inner node   | mask, low word | mask, high word | pointer | ... |   2 + popcount(mask) words
///   leaf block   | mask, low word | mask, high word |
///   pointer      word index of the child, in the order of the bits of the mask
///   mask         bit x + 4y + 16z: the cell (x,y,z) of the node's 4³ is not empty
///
/// Made from the paper's layout when a file is loaded, and never stored. Takes about 1.2 times the
/// bytes of the paper's layout.
#include <cstdint>
#include <vector>

#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// A view for kernels: points into a WideSvdag and owns nothing.
struct WideSvdagView {
  const std::uint32_t* words = nullptr;
  std::uint64_t word_count = 0;
  std::uint32_t root = 0;   ///< Word index.
  int levels = kMinLevels;  ///< L

  VOXDAG_HD bool is_empty() const { return word_count == 0; }
  VOXDAG_HD std::uint64_t bytes() const { return word_count * 4; }
};

/// A wide DAG in memory. The view is valid while this object lives unchanged.
struct WideSvdag {
  int levels = kMinLevels;
  std::uint32_t root = 0;
  std::vector<std::uint32_t> words;

  WideSvdagView view() const { return {words.data(), words.size(), root, levels}; }
};

/// Returns the voxels of `dag` in wide nodes. The DAG must be valid (see validate_svdag). Takes one
/// pass over the DAG, and scratch memory of up to half of the DAG's bytes. Throws Error if the
/// result needs 2^32 words or more.
WideSvdag make_wide_svdag(const SvdagView& dag);

/// Returns the bit in a wide node's mask that stands for child `inner` of child `outer`.
VOXDAG_HD constexpr int wide_cell(int outer, int inner) {
  const int x = (outer & 1) << 1 | (inner & 1);
  const int y = (outer & 2) | (inner >> 1 & 1);
  const int z = (outer >> 1 & 2) | (inner >> 2 & 1);
  return x | y << 2 | z << 4;
}

}  // namespace voxdag
