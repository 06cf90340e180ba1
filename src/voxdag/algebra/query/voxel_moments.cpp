#include "voxdag/algebra/query/voxel_moments.hpp"

#include "voxdag/core/int128.hpp"

namespace voxdag {
namespace {

/// The voxels of a cell, whose corner is (0, 0, 0).
struct CellMoments {
  std::uint64_t voxels = 0;
  Uint128 sum[3] = {};            ///< Of the coordinates.
  Box3i bounds = Box3i::empty();  ///< hi is the last voxel.

  /// Adds the voxels of a part whose corner is `corner`.
  void add(const CellMoments& part, Vec3i corner) {
    voxels += part.voxels;
    for (int axis = 0; axis < 3; ++axis)
      sum[axis] += part.sum[axis] + static_cast<Uint128>(corner[axis]) * part.voxels;
    bounds.extend(corner + part.bounds.lo);
    bounds.extend(corner + part.bounds.hi);
  }
};

CellMoments of_leaf_block(std::uint64_t block) {
  CellMoments moments;
  const CellMoments voxel{1, {}, {{0, 0, 0}, {0, 0, 0}}};
  for (; block != 0; block &= block - 1) {
    const int bit = static_cast<int>(std::countr_zero(block));
    moments.add(voxel, {leaf_coordinate(bit, 0), leaf_coordinate(bit, 1), leaf_coordinate(bit, 2)});
  }
  return moments;
}

}  // namespace

VoxelMoments moments_of(const SvdagView& dag, Work work) {
  if (dag.is_empty()) return {};
  // The moments of the nodes of the level below, at the word of the node divided by two: a node has
  // at least two words. Of leaf blocks, at their number.
  CountedVector<CellMoments> below(work.memory), here(work.memory);
  below.resize(dag.leaf_block_count);
  for (std::uint64_t i = 0; i < dag.leaf_block_count; ++i) {
    work.poll_seldom(i);
    below[i] = of_leaf_block(dag.leaf_blocks[i]);
  }
  for (int level = dag.levels - 3; level >= 0; --level) {
    const std::uint64_t begin = dag.level_begin[level], end = dag.level_begin[level + 1];
    const bool is_above_leaves = level == dag.levels - 3;
    const std::int32_t half = 1 << (dag.levels - level - 1);
    here.assign((end - begin + 1) / 2, CellMoments{});
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
  const CellMoments& all = below[0];
  VoxelMoments moments{all.voxels, {all.bounds.lo, all.bounds.hi + Vec3i{1, 1, 1}}, {}};
  for (int axis = 0; axis < 3; ++axis)
    moments.centre[axis] =
        static_cast<double>(2 * all.sum[axis] + all.voxels) / (2 * static_cast<double>(all.voxels));
  return moments;
}

}  // namespace voxdag
