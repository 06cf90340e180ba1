#pragma once
/// Iteration over the voxels of a DAG in Morton order, without a list of them in memory.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "voxdag/core/box.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// Returns all voxels of the grid, as a half-open box of voxel coordinates.
inline Box3i whole_grid(int levels) {
  const std::int32_t n = std::int32_t{1} << levels;
  return {{0, 0, 0}, {n, n, n}};
}

/// kLeafSlabs[axis][k] is the mask of the voxels of a leaf block whose coordinate on the axis is k.
inline constexpr std::array<std::array<std::uint64_t, 4>, 3> kLeafSlabs = [] {
  std::array<std::array<std::uint64_t, 4>, 3> slabs{};
  for (unsigned i = 0; i < 64; ++i) {
    const Vec3i voxel = morton_decode(i);
    for (int axis = 0; axis < 3; ++axis) slabs[axis][voxel[axis]] |= std::uint64_t{1} << i;
  }
  return slabs;
}();

/// Returns the mask of the voxels of the leaf block at `origin` that lie in the half-open `window`.
inline std::uint64_t leaf_window_mask(Vec3i origin, const Box3i& window) {
  std::uint64_t mask = ~std::uint64_t{0};
  for (int axis = 0; axis < 3; ++axis) {
    std::uint64_t inside = 0;
    for (int k = 0; k < 4; ++k)
      if (origin[axis] + k >= window.lo[axis] && origin[axis] + k < window.hi[axis])
        inside |= kLeafSlabs[axis][k];
    mask &= inside;
  }
  return mask;
}

namespace detail {

template <class Fn>
void walk_leaf_blocks(const SvdagView& dag, const Box3i& window, int level, std::uint32_t at,
                      Vec3i origin, const Fn& fn) {
  const std::int32_t size = std::int32_t{1} << (dag.levels - level);
  for (int axis = 0; axis < 3; ++axis)
    if (origin[axis] >= window.hi[axis] || origin[axis] + size <= window.lo[axis]) return;
  if (level == dag.levels - 2) {
    const std::uint64_t mask = dag.leaf_blocks[at] & leaf_window_mask(origin, window);
    if (mask != 0) fn(origin, mask);
    return;
  }
  const std::uint32_t* node = dag.nodes + at;
  const std::int32_t half = size / 2;
  const std::uint32_t* pointer = node + 1;
  for (std::uint32_t left = child_mask(node); left != 0; left &= left - 1) {
    const int i = std::countr_zero(left);
    const Vec3i child = origin + child_offset(i) * half;
    walk_leaf_blocks(dag, window, level + 1, *pointer++, child, fn);
  }
}

}  // namespace detail

/// Calls fn(Vec3i origin, std::uint64_t mask) for every leaf block that has voxels in the half-open
/// `window`, in Morton order; the mask holds only the voxels in the window. The window may extend
/// beyond the grid. The view must be valid. O(blocks met) time, a stack of L frames.
template <class Fn>
void for_each_leaf_block(const SvdagView& dag, const Box3i& window, const Fn& fn) {
  if (!dag.is_empty()) detail::walk_leaf_blocks(dag, window, 0, dag.root, {0, 0, 0}, fn);
}

/// Calls fn(Vec3i voxel) for every voxel in the half-open `window`, in the order of the view's
/// for_each_leaf_block(): Morton order for a DAG.
template <class View, class Fn>
void for_each_voxel(const View& voxels, const Box3i& window, const Fn& fn) {
  for_each_leaf_block(voxels, window, [&](Vec3i origin, std::uint64_t mask) {
    for (; mask != 0; mask &= mask - 1)
      fn(origin + morton_decode(static_cast<std::uint64_t>(std::countr_zero(mask))));
  });
}

}  // namespace voxdag
