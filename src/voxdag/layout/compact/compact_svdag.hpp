#pragma once
/// The compact form of a sparse voxel DAG: about a quarter of the paper's bytes, and walked as it
/// is.
///
/// Two ideas make it small. A node that only one pointer refers to, most of them, stands inline
/// after its parent and needs no pointer. And the masks of 16³ voxels are one number, coded by what
/// the reader knows of the cells around each mask. docs/compact.md tells why it works;
/// docs/format.md specifies it to the bit.
///
/// The coded levels are C = max(L, 4); a grid of fewer levels is the corner at (0,0,0) of one of
/// 16³ voxels. Nodes of level C-4 are *units*, nodes of level C-3 are *bricks*. A node with two or
/// more pointers to it, and the root, is *shared*. The shared nodes of a level are numbered by
/// falling number of pointers; equal ones keep the canonical order (layout/svdag.hpp). The shared
/// bricks are numbered by their masks first, then in this way.
///
///   stream    | root | shared nodes of level 1 | ... | shared bricks |      bits
///   node      of a level above the units: a record, then its inline children, each with what
///   follows
///             it, in the order of the child index
///   unit      one closed record, with the masks of its inline bricks
///   brick     shared: one closed record
///   shared_begin   of each level: the bit at which each shared node begins
///
/// symbol_coder.hpp defines records, unit_cells.hpp the masks of a unit, context_tree.hpp how a
/// symbol is coded.
#include <cstdint>
#include <span>
#include <vector>

#include "voxdag/core/grid.hpp"
#include "voxdag/layout/compact/context_tree.hpp"

namespace voxdag {

/// What each context tree codes.
enum CompactSymbol {
  kNodeMask,   ///< The child mask of a node of level C-4 or above.
  kChildKind,  ///< 0: an inline child. k > 0: a shared one whose number + 1 has k bits. The number
               ///< of a brick is counted from the first one with its mask.
  kUnitBits,   ///< The number of bits of a unit's length in bits.
  kBrickMask,
  kLeafMask,
  kCellMask,
  kCompactSymbols
};
/// The number of features of each.
inline constexpr int kCompactFeatures[kCompactSymbols] = {2, 40, 13, 64, 64, 64};
/// Symbols of each are below this number.
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
  /// Of level 0, level 1 and so on, and after the last one stream_bits.
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

/// Returns the number that tells levels apart in features: 0 for units, 1 for the level above, 2
/// for all others.
VOXDAG_HD constexpr std::uint32_t level_class(int level, int coded_levels) {
  const int above = coded_levels - 4 - level;
  return static_cast<std::uint32_t>(above < 2 ? above : 2);
}

/// Returns the features of the kind of child `index` of a node with this mask. `kinds` are those of
/// the children before it. Bits 0..7 are the mask, 8..10 the index, 11..28 the kinds of the
/// children at x-1, y-1 and z-1 (six bits each, 0 where there is none), 30..31 the class of the
/// node's level, and 32..39 the mask of the child if it is a brick.
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

/// Returns the features of the length of a unit, child `index` of a node with this mask, of whose
/// children `inline_left` are inline and not yet read: bits 0..7, 8..10, and 11..12 (3 at most).
VOXDAG_HD inline std::uint64_t unit_features(std::uint32_t mask, int index, int inline_left) {
  const int left = inline_left < 3 ? inline_left : 3;
  return mask | static_cast<std::uint64_t>(index) << 8 | static_cast<std::uint64_t>(left) << 11;
}

}  // namespace voxdag
