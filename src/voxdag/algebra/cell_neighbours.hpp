#pragma once
/// Tables of neighbours: voxels in and beside leaf blocks, and children of cells side by side.
#include <array>
#include <cstdint>
#include <vector>

#include "voxdag/algebra/grow.hpp"
#include "voxdag/core/vec.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

inline constexpr int kDirections = 13;

/// Returns the directions from a cell to its neighbours, but only one of each two opposite ones:
/// the first coordinate that is not 0 is 1.
inline constexpr std::array<Vec3i, kDirections> kSteps = [] {
  std::array<Vec3i, kDirections> steps{};
  int count = 0;
  for (int x = 0; x <= 1; ++x)
    for (int y = x == 0 ? 0 : -1; y <= 1; ++y)
      for (int z = x == 0 && y == 0 ? 1 : -1; z <= 1; ++z)
        steps[static_cast<std::size_t>(count++)] = {x, y, z};
  return steps;
}();

constexpr bool is_face(Vec3i step) { return dot(step, step) == 1; }

constexpr int step_axis(Vec3i step) { return step.x != 0 ? 0 : step.y != 0 ? 1 : 2; }

/// Returns the voxel of a leaf block that has this number.
inline Vec3i voxel_at(int voxel) {
  return {leaf_coordinate(voxel, 0), leaf_coordinate(voxel, 1), leaf_coordinate(voxel, 2)};
}

/// The neighbours of each voxel of a leaf block, and the voxels at its sides.
struct VoxelNeighbours {
  explicit VoxelNeighbours(Neighbours neighbours);

  std::uint64_t within[64] = {};               ///< The neighbours of a voxel in its block.
  std::uint64_t across[kDirections][64] = {};  ///< Those in the block beside it.
  std::uint64_t side[6] = {};                  ///< Low and high side of x, then of y, then of z.
};

const VoxelNeighbours& voxel_neighbours(Neighbours neighbours);

/// A child of a cell and one of the same cell, or of the cell beside it, that can touch.
struct ChildPair {
  int a, b;       ///< The children.
  int direction;  ///< From a to b, or from b to a if `is_swapped`.
  bool is_swapped;
};

struct ChildPairs {
  explicit ChildPairs(Neighbours neighbours);

  std::vector<ChildPair> within;               ///< Of one cell.
  std::vector<std::vector<ChildPair>> across;  ///< Of two cells, for each direction.
};

const ChildPairs& child_pairs(Neighbours neighbours);

}  // namespace voxdag
