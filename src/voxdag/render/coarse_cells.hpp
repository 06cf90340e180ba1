#pragma once
/// A scene at a low resolution, to judge its shape as a whole.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "voxdag/core/box.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/trace/visit_nodes.hpp"

namespace voxdag {

/// The non-empty cells of one level of a scene.
class CoarseCells {
 public:
  /// Collects the cells of level min(L, max_level), in Morton order.
  CoarseCells(const VoxelSet& scene, int max_level);
  /// Collects the cells of a node layout (see trace/svdag_nodes.hpp).
  template <class Nodes>
  static CoarseCells of(const Nodes& nodes, int max_level) {
    CoarseCells cells(std::min(nodes.levels(), max_level));
    if (!nodes.is_empty()) cells.collect(nodes, nodes.root(), 0, {});
    return cells;
  }

  int level() const { return level_; }
  std::int32_t side() const { return 1 << level_; }
  const std::vector<Vec3i>& cells() const { return cells_; }
  /// Returns the half-open bounds of the cells, in cells; the empty box if there are none.
  const Box3i& bounds() const { return bounds_; }
  /// Returns whether a cell is not empty; false outside the grid.
  bool contains(Vec3i cell) const;

  /// Returns the fraction (0 to 1) of one side of the bounds that cells cover. Counts only cells
  /// within `depth` cells of that side: the lower side along `axis` if `from_below`, else the
  /// upper.
  double side_cover(int axis, bool from_below, std::int32_t depth) const;

 private:
  explicit CoarseCells(int level) : level_(level), is_set_(std::size_t{1} << (3 * level)) {}

  void add(Vec3i cell);

  template <class Nodes>
  void collect(const Nodes& nodes, typename Nodes::Node node, int level, Vec3i cell) {
    if (level == level_) return add(cell);
    const std::uint32_t mask = nodes.child_mask(node, level);
    for (int i = 0; i < 8; ++i) {
      if ((mask >> i & 1u) == 0) continue;
      const Vec3i child = cell * 2 + child_offset(i);
      // Children of the last level are not read as nodes, because voxels have no nodes.
      const bool is_last = level + 1 == level_;
      collect(nodes, is_last ? node : nodes.child(node, level, i), level + 1, child);
    }
  }

  std::size_t index(Vec3i cell) const {
    return static_cast<std::size_t>((cell.z << level_ | cell.y) << level_ | cell.x);
  }

  int level_;
  std::vector<Vec3i> cells_;
  std::vector<bool> is_set_;
  Box3i bounds_ = Box3i::empty();
};

/// Returns the lowest coordinate of the voxels along an axis, in voxels; the grid's side if there
/// are none.
std::int64_t lowest_voxel(const VoxelSet& scene, int axis);

/// Returns the likely up direction: y, or z if the scene lies flat on z, or stands on much more of
/// the ground along z than along y.
Vec3d guess_up(const CoarseCells& scene);

}  // namespace voxdag
