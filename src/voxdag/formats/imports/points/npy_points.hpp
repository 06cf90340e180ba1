#pragma once
#include "voxdag/file/npy.hpp"
#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

/// Opens an array of N x 3 numbers of any type and order, or a structured array whose rows have the
/// fields x, y and z, or one of three items called voxel, position or xyz. Integers are voxels,
/// real numbers are points. The fields red, green and blue, or color, are colours.
std::unique_ptr<VoxelSource> open_npy_points(const std::filesystem::path& path,
                                             const NpyStart& start);

}  // namespace voxdag
