#pragma once
#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

/// Opens a grid of voxels, run-length encoded (Patrick Min, "binvox").
std::unique_ptr<VoxelSource> open_binvox(const std::filesystem::path& path);

}  // namespace voxdag
