#pragma once
/// Finds the coarse cells that a triangle meets.
#include <bit>
#include <cstdint>

#include "voxdag/builders/voxelize/cell_classify.hpp"
#include "voxdag/builders/voxelize/cell_range.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/builders/voxelize/triangle_setup.hpp"
#include "voxdag/core/morton.hpp"

namespace voxdag {

/// Finds cells of one octree level, in a grid of 2^levels voxels a side.
class CellFinder {
 public:
  /// Finds the cells of `level`, 0 to 10, that lie in `range`, which is of that level or a coarser
  /// one.
  CellFinder(int levels, int level, const CellRange& range = {})
      : levels_(levels), level_(level), range_(range) {}

  /// Calls body(code) with the Morton code of each cell that the triangle meets and, except in the
  /// largest grids, of no other. The codes ascend.
  template <class Body>
  void for_each(const QuantizedTriangle& t, const Body& body) const {
    const Vec3i lo = min(t.x, min(t.y, t.z)), hi = max(t.x, max(t.y, t.z));
    const int shift = levels_ - level_ + 8;  // 1/256 voxel to cells
    Vec3i first, last;
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = lo[axis] >> shift;
      last[axis] = hi[axis] >> shift;
      if (last[axis] < 0 || first[axis] >= std::int32_t{1} << level_) return;
    }
    if (first == last) {
      const auto code = static_cast<std::uint32_t>(morton_encode(first));
      if (range_.meets(level_, code)) body(code);
      return;
    }
    const TriangleSetup setup = make_triangle_setup(t, {0, 0, 0});
    descend(setup, setup.conditions, {0, 0, 0}, 0, 0, body);
  }

 private:
  /// Walks down from a cell that the triangle meets. The cell's first voxel is `origin`, its Morton
  /// code `code`.
  template <class Body>
  void descend(const TriangleSetup& setup, std::uint32_t conditions, Vec3i origin, int level,
               std::uint32_t code, const Body& body) const {
    if (!range_.meets(level, code)) return;
    if (level == level_) return body(code);
    const std::int32_t half = std::int32_t{1} << (levels_ - level - 1);
    const ChildConditions children = classify_children(setup, conditions, origin, half);
    for (std::uint32_t left = children.alive; left != 0; left &= left - 1) {
      const int child = std::countr_zero(left);
      descend(setup, children.conditions(child), origin + child_offset(child) * half, level + 1,
              code << 3 | static_cast<std::uint32_t>(child), body);
    }
  }

  int levels_, level_;
  CellRange range_;
};

}  // namespace voxdag
