#pragma once
/// Exports voxels as a folder of PNG files, one for each layer.
#include "voxdag/formats/exports/export_options.hpp"

namespace voxdag {

/// Writes slice_0000.png and so on: one file for each layer of the window along `axis` (0 to 2), in
/// ascending order, with as many digits as the last one needs, at least 4. Columns of pixels are
/// the first of the other axes, from the left, rows the second, from the top: for axis z, x and y.
/// Without colours, pixels have one bit: 1 for voxels. With a look that has colours, pixels are
/// RGBA: voxels are opaque, other places transparent black. Writes the placement as placement.json
/// into the folder, which appears when it is complete. With options.skip_empty, layers without
/// voxels have no file; the others keep their numbers. Throws Error if the folder exists and is not
/// empty, or if no layer is left.
void export_slices(const std::filesystem::path& folder, int axis, const VoxelSet& voxels,
                   const Grid& grid, const ExportOptions& options = {});

}  // namespace voxdag
