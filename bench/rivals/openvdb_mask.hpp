#pragma once
/// The voxels of a DAG as a mask grid of OpenVDB, for the rivals that walk such grids.
#include <openvdb/openvdb.h>

#include "voxdag/layout/for_each_voxel.hpp"
#include "voxdag/trace/ray.hpp"

namespace voxdag {

/// Makes a mask grid of the DAG's voxels; Coord allows up to 2^30 voxels a side. Voxel (i,j,k) is
/// the cube with its lower corner at (i,j,k), as in voxdag.
inline openvdb::MaskGrid::Ptr openvdb_mask_of(const SvdagView& dag) {
  auto grid = openvdb::MaskGrid::create();
  auto accessor = grid->getAccessor();
  const std::int32_t side = 1 << dag.levels;
  for_each_voxel(dag, {{0, 0, 0}, {side, side, side}}, [&](Vec3i v) {
    accessor.setValueOn({v.x, v.y, v.z});
  });
  return grid;
}

/// A ray in units of voxels, with the world ray's t.
struct VoxelRay {
  Vec3d origin, direction;
};

inline VoxelRay to_voxels(const Grid& grid, const Ray& ray) {
  return {grid.to_grid(static_cast<Vec3d>(ray.origin)),
          static_cast<Vec3d>(ray.direction) * (1 / grid.voxel_size)};
}

}  // namespace voxdag
