#pragma once
/// Finds the space that a body can reach among voxels.
#include "voxdag/core/grid.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/core/vec.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// The places that carve() writes around the space.
enum class CarveForm {
  kWall,   ///< Those beside it, over faces, edges and corners: a wall of one voxel.
  kSolid,  ///< All others of its box, and of one more voxel on each side.
};

/// Carves the space that a body can reach from `seed` out of solid matter. The body is the box of
/// places c - half to c + half around its place c.
///
/// The body may be at the places c of the box of all voxels at which it holds no voxel. Steps over
/// faces connect the places that it can reach from `seed`. The space is what the body holds at
/// these places, as far as it lies in the box of all voxels.
///
/// Returns the minimal DAG, in canonical order, of the places in the grid that `form` names. `dag`
/// must be valid, and components of `half` at least 0. Throws Error if the body cannot be at
/// `seed`, or if the result outgrows 32-bit pointers; OverMemory and Cancelled.
Svdag carve(const SvdagView& dag, Vec3i seed, Vec3i half, CarveForm form, Work work = {});

/// Returns `half` for the box of an upright capsule, in voxels that are rounded up: height / 2
/// along axis `up` (0, 1 or 2), `radius` along the others. All lengths are in world units.
Vec3i half_of_capsule(double height, double radius, int up, double voxel_size);

/// Returns the voxel of a finite place in the world; one outside of the grid for places outside.
Vec3i voxel_at(const Grid& grid, Vec3d place);

}  // namespace voxdag
