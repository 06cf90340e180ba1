#pragma once
/// Finds the voxels that the rays of a sensor end in, and those that they pass through.
#include <span>
#include <vector>

#include "voxdag/builders/voxelize/grid_request.hpp"
#include "voxdag/core/grid.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// Voxels that are neither occupied nor free are unknown: no ray met them.
struct RaySpace {
  Grid grid;
  Svdag occupied;  ///< The voxels in which rays that hit end.
  Svdag free;      ///< The voxels that rays pass through, without those that are occupied.
};

/// Returns the space of the rays from origins[i] to ends[i], in world units. `hits[i]`: the ray
/// ends at a surface; otherwise it passes through the voxel of its end, too. An empty `hits` stands
/// for true. There is one origin for each ray, or one for all.
///
/// The rule is that of the exact cover: points are rounded to 1/256 of a voxel, and a ray passes
/// through the voxels whose half-open cubes contain a point of it. Parts outside of `bounds` are
/// left out; without bounds the grid holds all rays. Throws Error if the numbers of rows differ or
/// a point is not finite, and as grid_for() and build_svdag() do.
RaySpace ray_space(std::span<const Vec3d> origins, std::span<const Vec3d> ends,
                   const std::vector<bool>& hits, const GridRequest& request, Work work = {});

}  // namespace voxdag
