#pragma once
/// Exports voxels as .binvox, the format of Patrick Min's voxelizer binvox.
#include "voxdag/formats/exports/export_options.hpp"

namespace voxdag {

/// Writes a cube of voxels from window.lo on, as large as the longest side of the window; places
/// beyond the window are empty. Its voxel (i, j, k) is voxel window.lo + (i, j, k). `translate` and
/// `scale` place it in the world.
void export_binvox(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                   const ExportOptions& options = {});

}  // namespace voxdag
