#pragma once
#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

/// Opens an array of NumPy: N × 3 int32 are voxels, N × 3 float32 or float64 are points.
std::unique_ptr<VoxelSource> open_npy_points(const std::filesystem::path& path);

}  // namespace voxdag
