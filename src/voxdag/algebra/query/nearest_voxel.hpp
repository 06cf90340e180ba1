#pragma once
/// The voxel of a DAG that is nearest to a point.
#include <cmath>
#include <optional>

#include "voxdag/core/vec.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

struct NearestVoxel {
  Vec3i voxel;
  double distance2 = 0;  ///< To the closed cube of the voxel, squared; 0 in it.
};

/// Returns the voxel nearest to `point`, which may lie anywhere. Units are voxels: voxel (i,j,k) is
/// the cube from (i,j,k) to (i+1,j+1,k+1). Of voxels at equal distances, the one that contains the
/// point counts, else that with the least x, then y, then z. Returns nothing if no voxel is within
/// `most2`, a squared distance. Visits the cells that are nearer than the result.
std::optional<NearestVoxel> nearest_voxel(const SvdagView& dag, Vec3d point,
                                          double most2 = HUGE_VAL);

}  // namespace voxdag
