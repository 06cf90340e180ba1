#pragma once
/// The node layout for rays at the wide DAG (stored/svdag/wide_svdag.hpp).
///
/// A wide layout for cast() is a type with
///   kIsWide             true
///   is_empty()          no voxels at all
///   levels()            L
///   root()              the word index of the root; not called on an empty DAG
///   mask(n)             the 64-bit mask of wide node or leaf block n
///   child(n, m, c)      the child at bit c, which is set in n's mask m
#include "voxdag/stored/svdag/wide_svdag.hpp"

namespace voxdag {

class WideNodes {
 public:
  using Node = std::uint32_t;
  static constexpr bool kIsWide = true;

  VOXDAG_HD explicit WideNodes(const WideSvdagView& dag)
      : words_(dag.words), root_(dag.root), levels_(dag.levels), is_empty_(dag.is_empty()) {}

  VOXDAG_HD bool is_empty() const { return is_empty_; }
  VOXDAG_HD int levels() const { return levels_; }
  VOXDAG_HD Node root() const { return root_; }
  VOXDAG_HD const std::uint32_t* words() const { return words_; }

  VOXDAG_HD std::uint64_t mask(Node node) const {
    return words_[node] | static_cast<std::uint64_t>(words_[node + 1]) << 32;
  }
  VOXDAG_HD Node child(Node node, std::uint64_t mask, std::uint32_t cell) const {
    const std::uint64_t below = (std::uint64_t{1} << cell) - 1;
    return words_[node + 2 + static_cast<std::uint32_t>(popcount64(mask & below))];
  }

 private:
  const std::uint32_t* words_;
  std::uint32_t root_;
  int levels_;
  bool is_empty_;
};

/// A layout that cast() walks in steps of two levels.
template <class Nodes>
concept WideLayout = Nodes::kIsWide;

/// The position bits that a wide walk uses in a grid of L levels.
struct WideLevels {
  int leaf_bit;  ///< The position bit in which neighbouring voxels differ.
  int root_bit;  ///< The position bit in which neighbouring cells of the root differ.

  VOXDAG_HD explicit WideLevels(int levels)
      : leaf_bit(23 - levels), root_bit(leaf_bit + 2 * ((levels + 1) / 2 - 1)) {}
};

/// The maximum number of wide nodes on the way from the root to a voxel.
inline constexpr int kMaxWideDepth = (kMaxLevels + 1) / 2;

/// The eight cells of a wide node's octant (0, 0), as bits of the 32-bit half of the mask that
/// holds them. For other octants, shift it by the octant's x and y.
inline constexpr std::uint32_t kOctantCells = 0x00330033u;

/// Returns the number that, XORed with the cell of a mirrored position, gives the cell in the mask.
VOXDAG_HD constexpr std::uint32_t wide_mirror(std::uint32_t mirrored) {
  return (mirrored & 1u) * 3 | (mirrored >> 1 & 1u) * 12 | (mirrored >> 2 & 1u) * 48;
}

/// Returns a mask of position bits. One of them changes if a step leaves the node whose cells have
/// the size 1 << bit, or leaves the grid (which may be an octant of the root).
VOXDAG_HD constexpr std::uint32_t leaves_node(int bit) { return ~3u << bit | ~0u << 23; }

}  // namespace voxdag
