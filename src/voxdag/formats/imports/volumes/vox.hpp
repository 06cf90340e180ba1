#pragma once
#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

/// Opens a scene of MagicaVoxel: every visible model, with the colours of the palette. A voxel
/// keeps its coordinates x, y, z (z is up), less the least ones of the scene, which are the origin
/// of grid(); a voxel has size 1. Animations show their first frame. Where models overlap, all of
/// them set the voxel. Format: see vox_file.hpp.
std::unique_ptr<VoxelSource> open_vox(const std::filesystem::path& path);

}  // namespace voxdag
