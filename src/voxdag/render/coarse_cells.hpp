#pragma once
/// A scene at a resolution at which it can be thought about as a whole.
#include <cstdint>
#include <vector>

#include "voxdag/core/box.hpp"
#include "voxdag/trace/voxel_scene.hpp"

namespace voxdag {

/// The non-empty cells of one level of a scene.
class CoarseCells {
 public:
  /// The cells of level min(L, max_level), in Morton order.
  CoarseCells(const VoxelScene& scene, int max_level);

  int level() const { return level_; }
  std::int32_t side() const { return 1 << level_; }
  const std::vector<Vec3i>& cells() const { return cells_; }
  /// Half-open, in cells; empty() if there are none.
  const Box3i& bounds() const { return bounds_; }
  /// False outside of the grid.
  bool contains(Vec3i cell) const;

  /// How much of one side of the bounds, seen along `axis` (from below if `from_below`), the cells
  /// within `depth` cells of it cover: 0 to 1.
  double side_cover(int axis, bool from_below, std::int32_t depth) const;

 private:
  std::size_t index(Vec3i cell) const {
    return static_cast<std::size_t>((cell.z << level_ | cell.y) << level_ | cell.x);
  }

  int level_;
  std::vector<Vec3i> cells_;
  std::vector<bool> is_set_;
  Box3i bounds_ = Box3i::empty();
};

}  // namespace voxdag
