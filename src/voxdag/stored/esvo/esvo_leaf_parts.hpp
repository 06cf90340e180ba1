#pragma once
/// Iteration over an ESVO's leaves as voxels of the finest level.
///
/// A leaf of the finest level is one voxel. A coarser leaf stands for the finest voxels in it whose
/// cubes meet the slabs of all contours that cut the leaf: its own and its ancestors'. These
/// include all voxels that the leaf's shape touches, so no voxel of the exact cover is missing.
#include <bit>
#include <cmath>
#include <cstdint>

#include "voxdag/core/morton.hpp"
#include "voxdag/stored/esvo/esvo.hpp"
#include "voxdag/stored/svdag/for_each_voxel.hpp"

namespace voxdag {
namespace detail {

template <class Fn>
class LeafPartWalk {
 public:
  LeafPartWalk(const EsvoView& esvo, const Box3i& window, const Fn& fn)
      : esvo_(esvo), window_(window), fn_(fn) {}

  /// Visits all leaves below the descriptor in `slot`, whose voxel begins at `origin`.
  void walk(std::uint64_t slot, int level, Vec3i origin) {
    const ChildDescriptor d = esvo_.descriptor(slot);
    const int log2_size = esvo_.levels - level - 1;
    for (std::uint32_t left = d.valid_mask(); left != 0; left &= left - 1) {
      const int child = std::countr_zero(left);
      const Vec3i at = origin + child_offset(child) * (std::int32_t{1} << log2_size);
      if (!meets_window(at, log2_size)) continue;
      const int slabs = slab_count_;
      if ((d.contour_mask() >> child & 1) != 0)
        slabs_[slab_count_++] = make_slab(esvo_.contour(slot, d, child), at, log2_size);
      if ((d.leaf_mask() >> child & 1) != 0) {
        leaf_ = {slot, child};
        walk_leaf(at, log2_size);
      } else {
        walk(esvo_.child(slot, d, child), level + 1, at);
      }
      slab_count_ = slabs;
    }
  }

 private:
  /// The points p, in voxels, with low <= dot(normal, p) <= high.
  struct Slab {
    Vec3d normal;
    double low, high, half_of_voxel;
  };

  static Slab make_slab(Contour contour, Vec3i origin, int log2_size) {
    const double half = 0.5 * static_cast<double>(std::int64_t{1} << log2_size);
    const Vec3i n = contour.normal();
    const std::int32_t n1 = length1(n);
    const auto normal = static_cast<Vec3d>(n);
    const double centre = dot(normal, static_cast<Vec3d>(origin) + Vec3d{half, half, half});
    return {normal, centre + half * contour_position<double>(n1, contour.low()),
            centre + half * contour_position<double>(n1, contour.high()), 0.5 * n1};
  }

  bool meets_window(Vec3i at, int log2_size) const {
    const std::int32_t size = std::int32_t{1} << log2_size;
    for (int axis = 0; axis < 3; ++axis)
      if (at[axis] >= window_.hi[axis] || at[axis] + size <= window_.lo[axis]) return false;
    return true;
  }

  bool meets_slabs(Vec3i at, int log2_size) const {
    const auto size = static_cast<double>(std::int64_t{1} << log2_size);
    const Vec3d centre = static_cast<Vec3d>(at) + Vec3d{0.5, 0.5, 0.5} * size;
    for (int i = 0; i < slab_count_; ++i) {
      const Slab& slab = slabs_[i];
      const double middle = dot(slab.normal, centre), reach = slab.half_of_voxel * size;
      if (middle - reach > slab.high || middle + reach < slab.low) return false;
    }
    return true;
  }

  void walk_leaf(Vec3i at, int log2_size) {
    if (!meets_window(at, log2_size)) return;
    // A leaf of the finest level always counts, even if a rounding error puts it outside its slabs.
    if (log2_size > 0 && !meets_slabs(at, log2_size)) return;
    if (log2_size <= 2) return emit(at, log2_size);
    const std::int32_t half = std::int32_t{1} << (log2_size - 1);
    for (int child = 0; child < 8; ++child)
      walk_leaf(at + child_offset(child) * half, log2_size - 1);
  }

  void emit(Vec3i at, int log2_size) {
    const Vec3i block{at.x & ~3, at.y & ~3, at.z & ~3};
    const std::uint64_t first = morton_encode(at - block);
    std::uint64_t mask = 0;
    for (std::uint64_t i = 0; i < std::uint64_t{1} << (3 * log2_size); ++i)
      if (log2_size == 0 || meets_slabs(at + morton_decode(i), 0))
        mask |= std::uint64_t{1} << (first + i);
    mask &= leaf_window_mask(block, window_);
    if (mask != 0) fn_(block, mask, leaf_);
  }

  const EsvoView& esvo_;
  const Box3i& window_;
  const Fn& fn_;
  EsvoVoxel leaf_;
  int slab_count_ = 0;
  Slab slabs_[kMaxLevels + 1];
};

}  // namespace detail

/// Calls fn(Vec3i origin, std::uint64_t mask, const EsvoVoxel& leaf) with the voxels in the
/// half-open `window` that each leaf stands for, in blocks of 4³ voxels, in Morton order. Calls it
/// once for each pair of a block and a leaf that has voxels in it. The view must be valid.
template <class Fn>
void for_each_leaf_part(const EsvoView& esvo, const Box3i& window, const Fn& fn) {
  if (!esvo.is_empty()) detail::LeafPartWalk<Fn>(esvo, window, fn).walk(esvo.root, 0, {});
}

/// Calls fn(Vec3i origin, std::uint64_t mask) once for each block of 4³ voxels that has any, in
/// Morton order, as for a DAG.
template <class Fn>
void for_each_leaf_block(const EsvoView& esvo, const Box3i& window, const Fn& fn) {
  Vec3i block{};
  std::uint64_t voxels = 0;
  for_each_leaf_part(esvo, window, [&](Vec3i origin, std::uint64_t mask, const EsvoVoxel&) {
    if (voxels != 0 && origin != block) {
      fn(block, voxels);
      voxels = 0;
    }
    block = origin;
    voxels |= mask;
  });
  if (voxels != 0) fn(block, voxels);
}

}  // namespace voxdag
