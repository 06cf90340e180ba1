#include "voxdag/algebra/query/voxel_moments.hpp"

#include "voxdag/core/int128.hpp"

namespace voxdag {
namespace {

/// The box of a cell's voxels. The cell's corner is (0, 0, 0).
struct CellBounds {
  Box3i bounds = Box3i::empty();  ///< hi is the last voxel.

  static CellBounds of_voxel() { return {{{0, 0, 0}, {0, 0, 0}}}; }
  /// Adds the voxels of a part whose corner is `corner`.
  void add(const CellBounds& part, Vec3i corner) {
    bounds.extend(corner + part.bounds.lo);
    bounds.extend(corner + part.bounds.hi);
  }
};

/// The number of a cell's voxels, too, and the sum of their coordinates.
struct CellMoments : CellBounds {
  std::uint64_t voxels = 0;
  Uint128 sum[3] = {};

  static CellMoments of_voxel() { return {CellBounds::of_voxel(), 1, {}}; }
  void add(const CellMoments& part, Vec3i corner) {
    CellBounds::add(part, corner);
    voxels += part.voxels;
    for (int axis = 0; axis < 3; ++axis)
      sum[axis] += part.sum[axis] + static_cast<Uint128>(corner[axis]) * part.voxels;
  }
};

template <class Cell>
Cell of_leaf_block(std::uint64_t block) {
  Cell moments;
  const Cell voxel = Cell::of_voxel();
  for (; block != 0; block &= block - 1) {
    const int bit = static_cast<int>(std::countr_zero(block));
    moments.add(voxel, {leaf_coordinate(bit, 0), leaf_coordinate(bit, 1), leaf_coordinate(bit, 2)});
  }
  return moments;
}

/// Returns the `Cell` of all voxels of a DAG that is not empty.
template <class Cell>
Cell of_all(const SvdagView& dag, Work work) {
  // The cells of the nodes of the level below, at the word of the node divided by two: a node has
  // at least two words. Of leaf blocks, at their number.
  CountedVector<Cell> below(work.memory), here(work.memory);
  below.resize(dag.leaf_block_count);
  for (std::uint64_t i = 0; i < dag.leaf_block_count; ++i) {
    work.poll_seldom(i);
    below[i] = of_leaf_block<Cell>(dag.leaf_blocks[i]);
  }
  for (int level = dag.levels - 3; level >= 0; --level) {
    const std::uint64_t begin = dag.level_begin[level], end = dag.level_begin[level + 1];
    const bool is_above_leaves = level == dag.levels - 3;
    const std::int32_t half = 1 << (dag.levels - level - 1);
    here.assign((end - begin + 1) / 2, Cell{});
    for (std::uint64_t at = begin; at < end;) {
      const std::uint32_t* const node = dag.nodes + at;
      work.poll_seldom(at);
      for (int child = 0; child < 8; ++child)
        if ((child_mask(node) >> child & 1) != 0) {
          const std::uint64_t place = child_pointer(node, child);
          here[(at - begin) / 2].add(below[is_above_leaves ? place : (place - end) / 2],
                                     Vec3i{child & 1, child >> 1 & 1, child >> 2} * half);
        }
      at += 1 + static_cast<std::uint64_t>(popcount8(child_mask(node)));
    }
    here.swap(below);
  }
  return below[0];
}

}  // namespace

Box3i bounds_of(const SvdagView& dag, Work work) {
  if (dag.is_empty()) return {};
  const Box3i bounds = of_all<CellBounds>(dag, work).bounds;
  return {bounds.lo, bounds.hi + Vec3i{1, 1, 1}};
}

VoxelMoments moments_of(const SvdagView& dag, Work work) {
  if (dag.is_empty()) return {};
  const CellMoments all = of_all<CellMoments>(dag, work);
  VoxelMoments moments{all.voxels, {all.bounds.lo, all.bounds.hi + Vec3i{1, 1, 1}}, {}};
  for (int axis = 0; axis < 3; ++axis)
    moments.centre[axis] =
        static_cast<double>(2 * all.sum[axis] + all.voxels) / (2 * static_cast<double>(all.voxels));
  return moments;
}

}  // namespace voxdag
