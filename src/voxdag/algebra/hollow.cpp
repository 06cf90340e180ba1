#include "voxdag/algebra/hollow.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "voxdag/algebra/coarsen.hpp"
#include "voxdag/algebra/combine.hpp"
#include "voxdag/algebra/components.hpp"
#include "voxdag/algebra/query/distance_field.hpp"
#include "voxdag/algebra/query/nearest_voxel.hpp"
#include "voxdag/algebra/voxels/morton_builder.hpp"
#include "voxdag/algebra/voxels/voxel_builder.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/stored/svdag/for_each_voxel.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"
#include "voxdag/stored/svdag/svdag_lookup.hpp"

namespace voxdag {
namespace {

/// Returns l for the cubes of 2^l voxels a side that are worked on one after the other. Each needs
/// the depths of `reach` places around it, too.
int cube_levels(int grid_levels, std::int32_t reach, const MemoryBudget* memory) {
  constexpr int kLeast = 6;
  int levels =
      std::max(kLeast, static_cast<int>(std::bit_width(4u * static_cast<unsigned>(reach) - 1)));
  const auto bytes = [&] {
    const double side = std::ldexp(1.0, levels) + 2.0 * reach;
    return sizeof(std::uint32_t) * side * side * side;
  };
  while (memory != nullptr && levels > 0 && bytes() > static_cast<double>(memory->left()) / 2)
    --levels;
  return std::min(levels, grid_levels - kMinLevels);
}

/// Returns the box with `reach` more places on each side, of those outside of the grid one.
Box3i with_margin(Box3i box, std::int32_t reach, std::int32_t grid_side) {
  for (int axis = 0; axis < 3; ++axis) {
    box.lo[axis] = std::max(box.lo[axis] - reach, -1);
    box.hi[axis] = std::min(box.hi[axis] + reach, grid_side + 1);
  }
  return box;
}

bool is_full(const SvdagView& dag, const Box3i& box) {
  const Vec3<std::int64_t> size(box.hi - box.lo);
  std::int64_t left = size.x * size.y * size.z;
  for_each_leaf_block(dag, box, [&](Vec3i, std::uint64_t mask) { left -= std::popcount(mask); });
  return left == 0;
}

/// Returns the voxels of `dag` whose centre is at most `radius` away from a segment.
Svdag capsule(const SvdagView& dag, Vec3d from, Vec3d to, double radius, Work work) {
  Box3i box;
  const double side = std::ldexp(1.0, dag.levels);
  for (int axis = 0; axis < 3; ++axis) {
    const auto clipped = [&](double at) {
      return static_cast<std::int32_t>(std::clamp(std::floor(at), 0.0, side));
    };
    box.lo[axis] = clipped(std::min(from[axis], to[axis]) - radius);
    box.hi[axis] = clipped(std::max(from[axis], to[axis]) + radius + 1);
  }
  const Vec3d along = to - from;
  const double length2 = dot(along, along);
  CountedVector<std::uint64_t> codes(work.memory);
  std::uint64_t visited = 0;
  for_each_voxel(dag, box, [&](Vec3i voxel) {
    work.poll_seldom(visited++);
    const Vec3d p = Vec3d(voxel) + Vec3d{0.5, 0.5, 0.5} - from;
    const double t = length2 > 0 ? std::clamp(dot(p, along) / length2, 0.0, 1.0) : 0;
    const Vec3d apart = p - along * t;
    if (dot(apart, apart) <= radius * radius) codes.push_back(morton_encode(voxel));
  });
  return svdag_of_sorted(dag.levels, codes, work.memory);
}

}  // namespace

Svdag keep_wall(const SvdagView& dag, double wall, Work work) {
  MortonBuilder builder(dag.levels, work.memory);
  if (dag.is_empty()) return builder.finish();
  const std::int32_t side = std::int32_t{1} << dag.levels;
  const double most = std::min(wall, 2.0 * side);  // No voxel is deeper.
  const auto reach = static_cast<std::int32_t>(std::floor(most + 0.5));
  const int levels = cube_levels(dag.levels, std::max(reach, 1), work.memory);
  const Svdag cubes = coarsen(dag, dag.levels - levels, work);
  const std::uint64_t count = count_svdag(cubes.view()).voxels;
  std::uint64_t done = 0;
  for_each_voxel(cubes.view(), whole_grid(cubes.levels), [&](Vec3i cube) {
    work.poll();
    work.report_done("wall", done++, count);
    const Box3i box{cube * (1 << levels), (cube + Vec3i{1, 1, 1}) * (1 << levels)};
    const Box3i around = with_margin(box, reach, side);
    if (is_full(dag, around)) return;
    const CountedVector<std::uint32_t> squares = depth_squares(dag, around, Work(work.memory));
    const Vec3<std::size_t> size(around.hi - around.lo);
    for_each_voxel(dag, box, [&](Vec3i voxel) {
      const Vec3<std::size_t> at(voxel - around.lo);
      if (static_cast<double>(squares[(at.z * size.y + at.y) * size.x + at.x]) <= 4 * most * most)
        builder.add(morton_encode(voxel));
    });
  });
  return builder.finish();
}

Svdag hollow(const SvdagView& dag, double wall, std::span<const Drain> drains, Work work) {
  Svdag body = keep_wall(dag, wall, work);
  const Svdag cavity = combine(dag, body.view(), SetOperation::kDifference, work);
  if (cavity.view().is_empty()) throw Error("has no voxels that are deeper than the wall");
  std::vector<Vec3i> ends;
  for (const Drain& drain : drains) {
    ends.push_back(nearest_voxel(cavity.view(), drain.at)->voxel);
    const Svdag hole = capsule(body.view(), drain.at, Vec3d(ends.back()) + Vec3d{0.5, 0.5, 0.5},
                               drain.radius, work);
    body = combine(body.view(), hole.view(), SetOperation::kDifference, work);
  }
  if (drains.empty()) return body;
  const Svdag filled = fill_cavities(body.view(), work);
  for (std::size_t i = 0; i < ends.size(); ++i)
    if (svdag_contains(filled.view(), ends[i], dag.levels))
      throw Error("drain " + std::to_string(i + 1) +
                  " does not open the cavity: it must begin on the surface, and be wider than a "
                  "voxel");
  return body;
}

}  // namespace voxdag
