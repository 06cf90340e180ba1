#pragma once
/// Finds the numbers of the cells that contain voxels, one voxel after the other.
#include <algorithm>
#include <bit>

#include "voxdag/stored/attributes/numbered_cell.hpp"

namespace voxdag {

/// Finds what find_cell_number() finds, faster if voxels are near the one before: the walk from the
/// root begins where their paths part. Each thread needs its own. Refers to the DAG's words.
class NumberFinder {
 public:
  NumberFinder(const SvdagView& dag, const CellIndexView& index) : dag_(dag), index_(index) {}

  /// Sets `number` to that of the cell of the finest level with attributes that contains `voxel`.
  /// Returns false if the DAG has no such cell, or if the voxel is outside the grid.
  bool find(Vec3i voxel, std::uint64_t& number) {
    const int finest = index_.finest_level, cut = dag_.levels - finest;
    const Vec3i cell{voxel.x >> cut, voxel.y >> cut, voxel.z >> cut};
    if (dag_.is_empty() || (cell.x | cell.y | cell.z) >> finest != 0) return false;
    const auto differing =
        static_cast<std::uint32_t>((cell.x ^ last_.x) | (cell.y ^ last_.y) | (cell.z ^ last_.z));
    int level = std::min(depth_, finest - static_cast<int>(std::bit_width(differing)));
    last_ = cell;
    for (; level < finest; ++level) {
      const int child = child_index(cell, finest - 1 - level);
      const NumberedCell& above = path_[level];
      if ((children_of(dag_, above) >> child & 1) == 0) break;
      path_[level + 1] = child_of(dag_, index_, above, child);
    }
    depth_ = level;
    number = path_[level].number;
    return level == finest;
  }

 private:
  SvdagView dag_;
  CellIndexView index_;
  Vec3i last_{};
  int depth_ = 0;  ///< path_[0] to path_[depth_] contain last_.
  NumberedCell path_[kMaxLevels + 1];
};

}  // namespace voxdag
