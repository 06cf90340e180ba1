#pragma once
/// Voxel sets as flat arrays: the reference for the algebra of DAGs.
#include <vector>

#include "support/brute_svdag.hpp"
#include "support/voxel_sets.hpp"

namespace voxdag {

/// One bool for each voxel of a grid of 2^levels.
class VoxelGrid {
 public:
  explicit VoxelGrid(int levels) : levels_(levels), set_(std::size_t{1} << (3 * levels)) {}
  VoxelGrid(int levels, const std::vector<Vec3i>& voxels) : VoxelGrid(levels) {
    for (const Vec3i v : voxels) set_[place(v)] = true;
  }

  int levels() const { return levels_; }
  /// Returns false outside the grid.
  bool contains(Vec3i v) const {
    return v.x >= 0 && v.y >= 0 && v.z >= 0 && (v.x | v.y | v.z) >> levels_ == 0 && set_[place(v)];
  }
  /// Returns the DAG of all voxels of a grid of 2^levels for which keep(v) is true.
  template <class Keep>
  static Svdag dag_of(int levels, const Keep& keep) {
    return brute_svdag(levels, voxels_where(levels, keep));
  }

 private:
  std::size_t place(Vec3i v) const {
    return static_cast<std::size_t>(v.x) |
           (static_cast<std::size_t>(v.y) | static_cast<std::size_t>(v.z) << levels_) << levels_;
  }

  int levels_;
  std::vector<bool> set_;
};

}  // namespace voxdag
