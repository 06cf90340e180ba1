#pragma once
/// Exports voxels as the grids of OpenVDB and NanoVDB.
#include "voxdag/formats/exports/export_options.hpp"

namespace voxdag {

/// Writes a grid "density" of floats, a fog volume: 1 and active at the voxels of the window, 0
/// elsewhere. With a look that has colours, a grid "Cd" of linear RGB follows. A path that ends in
/// .nvdb becomes a file of NanoVDB, any other one of OpenVDB. Index (i, j, k) is voxel (i, j, k),
/// and the transform maps it to the centre of the voxel in the world. Full cells of a DAG become
/// tiles if there are no colours.
/// OpenVDB holds the grids in memory: `options.memory` counts them. Throws Error if voxdag was
/// built without OpenVDB, and OverMemory.
void export_vdb(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                const ExportOptions& options = {});

}  // namespace voxdag
