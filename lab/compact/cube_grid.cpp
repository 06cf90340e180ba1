#include "lab/compact/cube_grid.hpp"

#include <algorithm>
#include <bit>

#include "lab/compact/symmetry.hpp"
#include "voxdag/core/morton.hpp"

namespace voxdag::lab {
namespace {

void add_node(const DagNodes& dag, int height, std::uint32_t node, Vec3i origin, CubeGrid& grid) {
  if (height == 2) {
    for (std::uint64_t rest = dag.leaf_blocks[node]; rest != 0; rest &= rest - 1)
      grid.set(origin + morton_decode(static_cast<std::uint32_t>(std::countr_zero(rest))));
    return;
  }
  const DagNodes::Node& children = dag.nodes[dag.nodes.size() + 2 - height][node];
  const int half = 1 << (height - 1);
  for (int octant = 0; octant < 8; ++octant)
    if (children[octant] != kNoNode)
      add_node(dag, height - 1, children[octant],
               origin + Vec3i{(octant & 1) * half, (octant >> 1 & 1) * half, (octant >> 2) * half},
               grid);
}

/// Returns a row moved by `by` voxels along itself.
std::uint16_t moved_row(std::uint16_t row, int by, int size) {
  const int moved = by >= 0 ? row << by : row >> -by;
  return static_cast<std::uint16_t>(moved & ((1 << size) - 1));
}

/// Returns the row of moved_grid().
std::uint16_t row_of_moved(const CubeGrid& grid, Vec3i by, int y, int z) {
  const int from_y = y - by.y, from_z = z - by.z;
  if (from_y < 0 || from_y >= grid.size || from_z < 0 || from_z >= grid.size) return 0;
  return moved_row(grid.rows[from_y + grid.size * from_z], by.x, grid.size);
}

}  // namespace

int CubeGrid::count() const {
  int count = 0;
  for (int i = 0; i < size * size; ++i) count += std::popcount(rows[i]);
  return count;
}

CubeGrid grid_of_node(const DagNodes& dag, int height, std::uint32_t node) {
  CubeGrid grid;
  grid.size = 1 << height;
  add_node(dag, height, node, {}, grid);
  return grid;
}

ImageIndex::ImageIndex(int symmetry, int size) {
  const auto index = [&](Vec3i voxel) {
    const Vec3i image = image_of_voxel(symmetry, voxel, size);
    return image.x + size * (image.y + size * image.z);
  };
  origin = index({0, 0, 0});
  step = {index({1, 0, 0}) - origin, index({0, 1, 0}) - origin, index({0, 0, 1}) - origin};
}

CubeGrid image_of_grid(int symmetry, const CubeGrid& grid) {
  const ImageIndex index(symmetry, grid.size);
  const int bits = std::countr_zero(static_cast<unsigned>(grid.size));
  CubeGrid image;
  image.size = grid.size;
  for_each_voxel(grid, [&](int x, int y, int z) {
    const int at = index(x, y, z);
    std::uint16_t& row = image.rows[at >> bits];
    row = static_cast<std::uint16_t>(row | 1 << (at & (grid.size - 1)));
  });
  return image;
}

CubeGrid moved_grid(const CubeGrid& grid, Vec3i by) {
  CubeGrid moved;
  moved.size = grid.size;
  for (int z = 0; z < grid.size; ++z)
    for (int y = 0; y < grid.size; ++y)
      moved.rows[y + grid.size * z] = row_of_moved(grid, by, y, z);
  return moved;
}

bool is_moved_grid(const CubeGrid& grid, Vec3i by, const CubeGrid& moved) {
  for (int z = 0; z < grid.size; ++z)
    for (int y = 0; y < grid.size; ++y)
      if (moved.rows[y + grid.size * z] != row_of_moved(grid, by, y, z)) return false;
  return true;
}

GridMargins margins_of(const CubeGrid& grid) {
  const int last = grid.size - 1;
  GridMargins margins{{last, last, last}, {last, last, last}};
  for_each_voxel(grid, [&](int x, int y, int z) {
    const Vec3i voxel{x, y, z};
    for (int axis = 0; axis < 3; ++axis) {
      margins.lo[axis] = std::min(margins.lo[axis], voxel[axis]);
      margins.hi[axis] = std::min(margins.hi[axis], last - voxel[axis]);
    }
  });
  return margins;
}

}  // namespace voxdag::lab
