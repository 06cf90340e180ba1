#include "voxdag/algebra/grow.hpp"

#include <algorithm>
#include <array>
#include <cassert>

#include "voxdag/algebra/query/voxel_moments.hpp"
#include "voxdag/algebra/source_dag.hpp"

namespace voxdag {
namespace {

/// Joins a grid with copies of itself that are moved `step` voxels up and down one axis.
///
/// A key is five nodes along the axis: the two source cells that the copy moved up has in the cell,
/// the source's own cell, and the two that the copy moved down has. ShiftRule (shift.cpp) explains
/// the pairs; a copy that is moved down by `step` has q = -1 and r = side - step.
///
/// A union is full where one of its parts is: then the key is that of a full cell, so that the
/// insides of thick bodies cost nothing.
class AxisRule {
 public:
  static constexpr std::size_t kWords = 5;
  using Key = std::array<std::uint32_t, kWords>;

  AxisRule(const SvdagView& dag, int axis, std::uint32_t step, bool is_union)
      : source_(dag), levels_(dag.levels), axis_(axis), is_union_(is_union) {
    const std::uint32_t side = 1u << levels_;
    assert(step > 0 && step < side);
    rest_[0] = step;
    rest_[1] = side - step;
    if (is_union) find_full_nodes(dag);
  }

  Key root() const {
    Key key = empty_key<kWords>();
    key[1] = key[2] = key[3] = source_.root();
    return simplified(0, key);
  }

  void prefetch(int, const Key& key) const {
    for (const std::uint32_t node : key) source_.prefetch(node);
  }

  void children(int level, const Key& key, Key (&keys)[8]) const {
    const int below = levels_ - level - 1;
    for (int child = 0; child < 8; ++child) {
      const int k = child >> axis_ & 1, across = child & ~(1 << axis_);
      Key& out = keys[child];
      out[2] = source_.child(level, key[2], child);
      for (int copy = 0; copy < 2; ++copy) {
        const int b = static_cast<int>(rest_[copy] >> below & 1);
        for (int larger = 0; larger < 2; ++larger) {
          const int half = 1 + k - b + larger;
          const std::size_t slot = static_cast<std::size_t>(3 * copy);
          out[slot + static_cast<std::size_t>(larger)] =
              larger == 0 && is_aligned(copy, level + 1)
                  ? kNoCell
                  : source_.child(level, key[slot + static_cast<std::size_t>(half >> 1)],
                                  across | (half & 1) << axis_);
        }
      }
      out = simplified(level + 1, out);
    }
  }

  std::uint64_t block(const Key& key) const {
    const std::uint64_t up = moved(source_.block(key[0]), source_.block(key[1]), rest_[0]);
    const std::uint64_t own = source_.block(key[2]);
    const std::uint64_t down = moved(source_.block(key[3]), source_.block(key[4]), rest_[1]);
    return is_union_ ? up | own | down : up & own & down;
  }

 private:
  Key simplified(int level, const Key& key) const {
    if (!is_union_) {
      const bool is_empty = key[2] == kNoCell || (key[0] == kNoCell && key[1] == kNoCell) ||
                            (key[3] == kNoCell && key[4] == kNoCell);
      return is_empty ? empty_key<kWords>() : key;
    }
    const std::uint32_t full = full_[static_cast<std::size_t>(level)];
    if (full == kNoCell) return key;
    bool is_full = key[2] == full;
    for (int copy = 0; copy < 2; ++copy) {
      const std::size_t slot = static_cast<std::size_t>(3 * copy);
      is_full |= key[slot + 1] == full && (key[slot] == full || is_aligned(copy, level));
    }
    if (!is_full) return key;
    Key own = empty_key<kWords>();
    own[2] = full;
    return own;
  }
  /// Returns whether the cells of a level lie upon cells of the copy.
  bool is_aligned(int copy, int level) const {
    return (rest_[copy] & ((1u << (levels_ - level)) - 1)) == 0;
  }
  /// Finds the node of each level whose voxels are all set: a DAG has at most one.
  void find_full_nodes(const SvdagView& dag) {
    full_.fill(kNoCell);
    std::uint32_t below = kNoCell;
    for (std::uint32_t i = 0; i < dag.leaf_block_count && below == kNoCell; ++i)
      if (dag.leaf_blocks[i] == ~std::uint64_t{0}) below = i;
    for (int level = levels_ - 2; below != kNoCell; --level) {
      full_[static_cast<std::size_t>(level)] = below;
      if (level == 0) break;
      const std::uint32_t part = below;
      below = kNoCell;
      const std::uint64_t end = dag.level_begin[level];
      for (std::uint64_t at = dag.level_begin[level - 1]; at < end && below == kNoCell;) {
        const std::uint32_t* const node = dag.nodes + at;
        if (child_mask(node) == 255 &&
            std::all_of(node + 1, node + 9, [&](std::uint32_t child) { return child == part; }))
          below = static_cast<std::uint32_t>(at);
        at += static_cast<std::uint64_t>(words_of_node(node));
      }
    }
  }
  /// Returns the block whose lower corner is `rest` modulo 4 voxels below that of `larger`.
  std::uint64_t moved(std::uint64_t smaller, std::uint64_t larger, std::uint32_t rest) const {
    const int r = static_cast<int>(rest & 3);
    std::uint64_t result = 0;
    for (int coordinate = 0; coordinate < 4; ++coordinate) {
      const int from = 4 + coordinate - r;
      const std::uint64_t source = from < 4 ? smaller : larger;
      result |= (source >> leaf_bits(from & 3, axis_) & plane()) << leaf_bits(coordinate, axis_);
    }
    return result;
  }
  /// Returns the voxels with coordinate 0 along the axis.
  std::uint64_t plane() const {
    constexpr std::uint64_t kPlanes[] = {0x0055005500550055, 0x0000333300003333,
                                         0x000000000F0F0F0F};
    return kPlanes[axis_];
  }

  SourceDag source_;
  int levels_, axis_;
  bool is_union_;
  std::uint32_t rest_[2];  ///< The offsets of the copies, modulo the side of the grid.
  std::array<std::uint32_t, kMaxLevels> full_{};  ///< For unions: the full node of each level.
};

/// Joins a grid with its six copies that are moved by one voxel. A key is a node and its neighbours
/// of the same size: that at the smaller coordinate of axis a is word 1 + 2a, the other word 2 +
/// 2a.
class StarRule {
 public:
  static constexpr std::size_t kWords = 7;
  using Key = std::array<std::uint32_t, kWords>;

  StarRule(const SvdagView& dag, bool is_union) : source_(dag), is_union_(is_union) {}

  Key root() const {
    Key key = empty_key<kWords>();
    key[0] = source_.root();
    return key;
  }
  void children(int level, const Key& key, Key (&keys)[8]) const {
    for (int child = 0; child < 8; ++child) {
      Key& out = keys[child];
      out[0] = source_.child(level, key[0], child);
      for (int axis = 0; axis < 3; ++axis)
        for (int larger = 0; larger < 2; ++larger) {
          const bool is_sibling = (child >> axis & 1) != larger;
          const std::uint32_t parent = key[is_sibling ? 0 : slot(axis, larger)];
          out[slot(axis, larger)] = source_.child(level, parent, child ^ 1 << axis);
        }
      if (!is_union_ && out[0] == kNoCell) out = empty_key<kWords>();
    }
  }
  std::uint64_t block(const Key& key) const {
    const std::uint64_t own = source_.block(key[0]);
    std::uint64_t result = own;
    for (int axis = 0; axis < 3; ++axis)
      for (int larger = 0; larger < 2; ++larger) {
        const std::uint64_t copy = moved(own, source_.block(key[slot(axis, larger)]), axis, larger);
        result = is_union_ ? result | copy : result & copy;
      }
    return result;
  }

 private:
  static std::size_t slot(int axis, int larger) {
    return static_cast<std::size_t>(1 + 2 * axis + larger);
  }
  /// Returns for each voxel whether its neighbour is set.
  static std::uint64_t moved(std::uint64_t own, std::uint64_t beside, int axis, int larger) {
    std::uint64_t result = 0;
    for (int voxel = 0; voxel < 64; ++voxel) {
      const int at = leaf_coordinate(voxel, axis) + (larger != 0 ? 1 : -1);
      const int neighbour = (voxel & ~leaf_bits(3, axis)) | leaf_bits(at & 3, axis);
      result |= ((at < 0 || at > 3 ? beside : own) >> neighbour & 1) << voxel;
    }
    return result;
  }

  SourceDag source_;
  bool is_union_;
};

Svdag copy_of(const SvdagView& dag) {
  Svdag copy;
  copy.levels = dag.levels;
  copy.nodes.assign(dag.nodes, dag.nodes + dag.node_words());
  copy.leaf_blocks.assign(dag.leaf_blocks, dag.leaf_blocks + dag.leaf_block_count);
  std::copy(std::begin(dag.level_begin), std::end(dag.level_begin), copy.level_begin.begin());
  return copy;
}

/// Joins a grid with all its copies that are moved by at most half[axis] voxels along each axis.
Svdag join_box(const SvdagView& dag, Vec3i half, bool is_union, Work work) {
  Svdag result = copy_of(dag);
  const int side = 1 << dag.levels;
  const Box3i bounds = std::max({half.x, half.y, half.z}) > 1 ? bounds_of(dag, work) : Box3i{};
  for (int axis = 0; axis < 3; ++axis) {
    assert(half[axis] >= 0);
    for (int reach = 0; reach < std::min(half[axis], side);) {
      // Copies that are moved by 2 reach + 1 voxels leave no gaps, unless a body is cut by a side
      // of the grid: then those that are moved by reach + 1 do.
      const bool is_cut = is_union && (bounds.lo[axis] < reach || bounds.hi[axis] > side - reach);
      const int step = std::min({is_cut ? reach + 1 : 2 * reach + 1, half[axis] - reach, side - 1});
      result = rewrite(AxisRule(result.view(), axis, static_cast<std::uint32_t>(step), is_union),
                       dag.levels, work);
      reach += step;
    }
  }
  return result;
}

Svdag join_neighbours(const SvdagView& dag, int steps, Neighbours neighbours, bool is_union,
                      Work work) {
  assert(steps >= 0);
  if (neighbours == Neighbours::k26) return join_box(dag, {steps, steps, steps}, is_union, work);
  Svdag result = copy_of(dag);
  steps = std::min(steps, 3 << dag.levels);
  for (int step = 0; step < steps; ++step) {
    Svdag next = rewrite(StarRule(result.view(), is_union), dag.levels, work);
    if (next == result) break;
    result = std::move(next);
  }
  return result;
}

}  // namespace

Svdag dilate(const SvdagView& dag, int steps, Neighbours neighbours, Work work) {
  return join_neighbours(dag, steps, neighbours, true, work);
}

Svdag dilate_box(const SvdagView& dag, Vec3i half, Work work) {
  return join_box(dag, half, true, work);
}

Svdag erode(const SvdagView& dag, int steps, Neighbours neighbours, Work work) {
  return join_neighbours(dag, steps, neighbours, false, work);
}

}  // namespace voxdag
