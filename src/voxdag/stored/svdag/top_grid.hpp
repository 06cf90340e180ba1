#pragma once
/// A dense grid of the cells of one level of a DAG. A ray crosses empty space in it in long steps,
/// and starts deep in the tree.
///
/// A cell is a 64-bit word, at x + (y << level) + (z << 2 * level):
///
///   not empty    | 0 (32 bits) | node: word index or leaf block (32 bits) |
///   empty        | free way in octant 0 (8 bits) | ... | octant 7 |
///
/// The free way in an octant is the side, in cells, of the largest empty cube that has this cell at
/// a corner and lies in the octant's directions: bit a of the octant is set if it lies upwards on
/// axis a. It is at most 255; beyond the grid everything is empty. One distance to the nearest
/// voxel would be short beside every surface; by octant it is long for rays that leave the surface.
///
/// Made from a DAG when a device gets it, and never stored.
#include <cstdint>
#include <vector>

#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// A view for kernels: points into a TopGrid and owns nothing.
struct TopGridView {
  const std::uint64_t* cells = nullptr;
  int level = 0;  ///< The level of the cells, 1 to L-2; 0: there are none.

  VOXDAG_HD static bool is_empty(std::uint64_t cell) { return (cell & 0xFFu) != 0; }
  VOXDAG_HD static std::uint32_t node(std::uint64_t cell) {
    return static_cast<std::uint32_t>(cell >> 32);
  }
  VOXDAG_HD static std::uint32_t free_way(std::uint64_t cell, std::uint32_t octant) {
    return static_cast<std::uint32_t>(cell >> (8 * octant)) & 0xFFu;
  }
};

struct TopGrid {
  int level = 0;
  std::vector<std::uint64_t> cells;

  TopGridView view() const { return {cells.data(), level}; }
};

/// Returns the level of the grid that devices get for a DAG of L levels: 8 (256³ cells, 128 MiB),
/// but at most L-2.
constexpr int top_level(int levels) { return levels - 2 < 8 ? levels - 2 : 8; }

/// Returns the grid of a level, 0 to L-2. Takes O(8^level) time.
TopGrid make_top_grid(const SvdagView& dag, int level);

}  // namespace voxdag
