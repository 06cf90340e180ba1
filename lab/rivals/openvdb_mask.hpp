#pragma once
/// Converts a DAG into a mask grid of OpenVDB, for the rivals that walk such grids.
#include <openvdb/openvdb.h>

#include "voxdag/stored/svdag/for_each_voxel.hpp"

namespace voxdag::lab {

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

}  // namespace voxdag::lab
