#pragma once
/// The compact form of a sparse voxel DAG: a quarter of the paper's bytes, and rays can walk it.
///
/// Two ideas make it small. Most nodes have one pointer to them. Such a node stands *inline*, right
/// after its parent, and needs no pointer. And the masks in 16³ voxels are coded as one number,
/// each mask in the context of the masks around it. docs/compact.md explains why this works;
/// docs/format.md specifies it to the bit.
///
/// The coded levels are C = max(L, 4). A grid of fewer levels is coded as the corner at (0,0,0) of
/// a grid of 16³ voxels. Nodes of level C-4 are *units*, nodes of level C-3 are *bricks*. The root,
/// and each node with two or more pointers to it, is *shared*. The shared nodes of a level are
/// numbered by decreasing number of pointers; equal ones keep the canonical order (svdag.hpp).
/// Shared bricks are numbered by their masks first, and those with equal masks in this way.
///
///   stream        | root | shared nodes of level 1 | ... | shared bricks |    bits
///   shared_begin  the first bit of each shared node
///
///   node above the units   an open record, then its inline children in Morton order, each with
///                          all that is inline below it
///   unit                   one closed record, which holds its inline bricks
///   shared brick           one closed record
///
/// symbol_coder.hpp defines records, unit_cells.hpp the contexts of masks, and context_tree.hpp how
/// a symbol is coded in its context.
#include <cstdint>
#include <span>
#include <vector>

#include "voxdag/core/grid.hpp"
#include "voxdag/stored/compact/context_tree.hpp"

namespace voxdag {

/// The kinds of symbols. Each has a context tree of its own.
enum CompactSymbol {
  kNodeMask,   ///< The child mask of a node of level C-4 or above.
  kChildKind,  ///< 0 for an inline child; k for a shared one whose number + 1 has k bits. Numbers
               ///< of bricks count from the first brick with the same mask.
  kUnitBits,   ///< How many bits the length of a unit has; the length itself counts bits.
  kBrickMask,
  kLeafMask,
  kCellMask,
  kCompactSymbols
};
/// The number of features of each kind.
inline constexpr int kCompactFeatures[kCompactSymbols] = {2, 40, 13, 64, 64, 64};
/// The symbols of each kind are below this number.
inline constexpr std::uint32_t kCompactAlphabet[kCompactSymbols] = {256, 33, 64, 256, 256, 256};

/// A view for kernels: points into a CompactSvdag and owns nothing.
struct CompactSvdagView {
  const std::uint32_t* stream = nullptr;
  std::uint64_t stream_bits = 0;
  /// Shared node n of level l begins at bit shared_begin[shared_first[l] + n], and ends where the
  /// next entry begins.
  const std::uint64_t* shared_begin = nullptr;
  std::uint64_t shared_first[kMaxLevels + 1] = {};
  /// The shared bricks with mask m have the numbers brick_first[m] to brick_first[m + 1] - 1.
  const std::uint64_t* brick_first = nullptr;
  ContextTreeView trees[kCompactSymbols];
  int levels = kMinLevels;  ///< L

  VOXDAG_HD int coded_levels() const { return levels < 4 ? 4 : levels; }
  VOXDAG_HD bool is_empty() const { return shared_first[1] == 0; }
  /// Returns the number of shared nodes of a level 0 to C-3.
  VOXDAG_HD std::uint64_t shared_nodes(int level) const {
    return shared_first[level + 1] - shared_first[level];
  }
};

/// A compact DAG in memory. The view is valid while this object lives unchanged.
struct CompactSvdag {
  int levels = kMinLevels;
  std::uint64_t stream_bits = 0;
  std::vector<std::uint32_t> stream{0, 0};
  /// The first bit of each shared node, level after level; then stream_bits.
  std::vector<std::uint64_t> shared_begin{0};
  std::vector<std::uint64_t> shared_counts;  ///< Of levels 0 to C-3; empty if there are no voxels.
  std::vector<std::uint64_t> brick_first = std::vector<std::uint64_t>(257);
  ContextTree trees[kCompactSymbols];

  bool is_empty() const { return shared_counts.empty(); }
  /// Returns the words of the stream; none if there are no voxels.
  std::span<const std::uint32_t> words() const {
    return std::span(stream).first(is_empty() ? 0 : stream.size());
  }
  CompactSvdagView view() const;
};

/// Returns the class of a level, a feature: 0 for units, 1 for the level above, 2 for all others.
VOXDAG_HD constexpr std::uint32_t level_class(int level, int coded_levels) {
  const int above = coded_levels - 4 - level;
  return static_cast<std::uint32_t>(above < 2 ? above : 2);
}

/// Returns the features of the kind of child `index` of a node. `kinds` has the kinds of the
/// children before it, and 0 where there is no child.
///
///   bits 0..7     the child mask of the node
///   bits 8..10    the index
///   bits 11..28   the kinds of the children at x-1, y-1 and z-1 in the node, six bits each
///   bits 30..31   the class of the node's level
///   bits 32..39   the mask of the child if it is a brick
VOXDAG_HD inline std::uint64_t kind_features(std::uint32_t mask, int index,
                                             const std::uint8_t (&kinds)[8],
                                             std::uint32_t node_class, std::uint32_t brick_mask) {
  std::uint64_t features = mask | static_cast<std::uint64_t>(index) << 8;
  for (int axis = 0; axis < 3; ++axis)
    if ((index >> axis & 1) != 0)
      features |= static_cast<std::uint64_t>(kinds[index ^ 1 << axis]) << (11 + 6 * axis);
  return features | static_cast<std::uint64_t>(node_class) << 30 |
         static_cast<std::uint64_t>(brick_mask) << 32;
}

/// Returns the features of the length of a unit that is child `index` of a node: the child mask of
/// the node in bits 0..7, the index in bits 8..10, and in bits 11..12 how many inline children the
/// node has from this one on, 3 at most.
VOXDAG_HD inline std::uint64_t unit_features(std::uint32_t mask, int index, int inline_left) {
  const int left = inline_left < 3 ? inline_left : 3;
  return mask | static_cast<std::uint64_t>(index) << 8 | static_cast<std::uint64_t>(left) << 11;
}

}  // namespace voxdag
