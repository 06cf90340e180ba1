#include "voxdag/algebra/cell_neighbours.hpp"

#include <algorithm>
#include <cstdlib>

#include "voxdag/core/morton.hpp"

namespace voxdag {
namespace {

/// Returns the direction with this step, or that of the opposite step; -1: not a step.
int direction_of(Vec3i step, bool& is_opposite) {
  for (int i = 0; i < kDirections; ++i)
    for (const bool opposite : {false, true})
      if (kSteps[static_cast<std::size_t>(i)] == (opposite ? -step : step)) {
        is_opposite = opposite;
        return i;
      }
  return -1;
}

bool are_near(Vec3i a, Vec3i b, Neighbours neighbours) {
  const Vec3i d = a - b;
  const std::int32_t most = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
  return neighbours == Neighbours::k26 ? most == 1 : dot(d, d) == 1;
}

std::vector<ChildPair> find_child_pairs(Vec3i step, Neighbours neighbours) {
  std::vector<ChildPair> pairs;
  const bool is_one_cell = step == Vec3i{};
  for (int a = 0; a < 8; ++a)
    for (int b = is_one_cell ? a + 1 : 0; b < 8; ++b) {
      const Vec3i apart = child_offset(b) + step * 2 - child_offset(a);
      bool is_opposite = false;
      const int direction = direction_of(apart, is_opposite);
      if (direction < 0 || (neighbours == Neighbours::k6 && !is_face(apart))) continue;
      pairs.push_back({a, b, direction, is_opposite});
    }
  // Pairs that share a face come first: they join most regions, so that other pairs need no search.
  std::stable_sort(pairs.begin(), pairs.end(), [](const ChildPair& a, const ChildPair& b) {
    const Vec3i u = kSteps[static_cast<std::size_t>(a.direction)];
    const Vec3i v = kSteps[static_cast<std::size_t>(b.direction)];
    return dot(u, u) < dot(v, v);
  });
  return pairs;
}

}  // namespace

VoxelNeighbours::VoxelNeighbours(Neighbours neighbours) {
  for (int a = 0; a < 64; ++a)
    for (int b = 0; b < 64; ++b) {
      const std::uint64_t bit = std::uint64_t{1} << b;
      if (are_near(voxel_at(a), voxel_at(b), neighbours)) within[a] |= bit;
      for (int i = 0; i < kDirections; ++i)
        if (are_near(voxel_at(a), voxel_at(b) + kSteps[static_cast<std::size_t>(i)] * 4,
                     neighbours))
          across[i][a] |= bit;
    }
  for (int voxel = 0; voxel < 64; ++voxel)
    for (int axis = 0; axis < 3; ++axis) {
      if (leaf_coordinate(voxel, axis) == 0) side[2 * axis] |= std::uint64_t{1} << voxel;
      if (leaf_coordinate(voxel, axis) == 3) side[2 * axis + 1] |= std::uint64_t{1} << voxel;
    }
}

const VoxelNeighbours& voxel_neighbours(Neighbours neighbours) {
  static const VoxelNeighbours faces(Neighbours::k6), all(Neighbours::k26);
  return neighbours == Neighbours::k6 ? faces : all;
}

ChildPairs::ChildPairs(Neighbours neighbours) : within(find_child_pairs({}, neighbours)) {
  for (const Vec3i step : kSteps) across.push_back(find_child_pairs(step, neighbours));
}

const ChildPairs& child_pairs(Neighbours neighbours) {
  static const ChildPairs faces(Neighbours::k6), all(Neighbours::k26);
  return neighbours == Neighbours::k6 ? faces : all;
}

}  // namespace voxdag
