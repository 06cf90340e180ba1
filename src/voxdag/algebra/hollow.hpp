#pragma once
/// Hollows bodies out, and opens the cavity.
#include <span>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/core/vec.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// A round hole from a point to the nearest voxel of the cavity. Units are voxels: voxel (i,j,k) is
/// the cube from (i,j,k) to (i+1,j+1,k+1).
struct Drain {
  Vec3d at;
  double radius = 0;
};

/// Returns the minimal DAG, in canonical order, of the voxels whose depth is at most `wall` voxels:
/// the Euclidean distance from the centre of the voxel to the cube of the nearest empty place. All
/// places outside of the grid are empty. Works in cubes that fit into half of the memory that
/// `work` has left. Throws Error if the wall has more than some 9,000 voxels, OverMemory and
/// Cancelled.
Svdag keep_wall(const SvdagView& dag, double wall, Work work = {});

/// Returns keep_wall() without the voxels of the drains. A drain removes the voxels whose centre is
/// at most its radius away from the segment from its point to the centre of the nearest voxel that
/// keep_wall() removes. Throws Error, too, if no voxel is deeper than the wall, or if a drain does
/// not connect the cavity with the sides of the grid over faces.
Svdag hollow(const SvdagView& dag, double wall, std::span<const Drain> drains, Work work = {});

}  // namespace voxdag
