#pragma once
/// The voxels of a node as a grid of 4³, 8³ or 16³ bits.
#include <array>
#include <bit>
#include <cstdint>

#include "lab/compact/dag_nodes.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag::lab {

/// A cube of `size`³ voxels, as rows: bit x of row y + size * z.
struct CubeGrid {
  static constexpr int kMaxSize = 16;

  int size = 4;
  std::array<std::uint16_t, kMaxSize * kMaxSize> rows{};

  bool at(Vec3i voxel) const { return ((rows[voxel.y + size * voxel.z] >> voxel.x) & 1) != 0; }
  void set(Vec3i voxel) {
    std::uint16_t& row = rows[voxel.y + size * voxel.z];
    row = static_cast<std::uint16_t>(row | 1 << voxel.x);
  }
  int count() const;
  friend bool operator==(const CubeGrid&, const CubeGrid&) = default;
};

/// Calls visit(x, y, z) for each voxel.
template <class Visit>
void for_each_voxel(const CubeGrid& grid, const Visit& visit) {
  for (int z = 0; z < grid.size; ++z)
    for (int y = 0; y < grid.size; ++y)
      for (unsigned row = grid.rows[y + grid.size * z]; row != 0; row &= row - 1)
        visit(std::countr_zero(row), y, z);
}

/// The number of a voxel's image (symmetry.hpp) in a cube of size³ voxels: x + size * (y + size *
/// z) of the image.
struct ImageIndex {
  int origin = 0;
  Vec3i step;

  ImageIndex(int symmetry, int size);
  int operator()(int x, int y, int z) const {
    return origin + step.x * x + step.y * y + step.z * z;
  }
};

/// Returns the voxels of a node of the DAG. `height` is 2 for a leaf block (4³ voxels), 3 for a
/// node above leaf blocks (8³), 4 for the next (16³).
CubeGrid grid_of_node(const DagNodes& dag, int height, std::uint32_t node);

/// Returns the image of a cube under a symmetry (symmetry.hpp).
CubeGrid image_of_grid(int symmetry, const CubeGrid& grid);

/// Returns the cube moved by `by` voxels; voxels that leave it are lost.
CubeGrid moved_grid(const CubeGrid& grid, Vec3i by);

/// Returns whether moved_grid(grid, by) == moved.
bool is_moved_grid(const CubeGrid& grid, Vec3i by, const CubeGrid& moved);

/// The numbers of empty layers of a cube at the lower and the upper end of each axis.
struct GridMargins {
  Vec3i lo, hi;

  bool any() const { return lo != Vec3i{} || hi != Vec3i{}; }
};
/// The cube must not be empty.
GridMargins margins_of(const CubeGrid& grid);

}  // namespace voxdag::lab
