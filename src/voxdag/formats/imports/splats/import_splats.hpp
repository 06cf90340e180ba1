#pragma once
/// Builds DAGs from Gaussian splats. docs/splats.md states the rule.
#include "voxdag/formats/imports/import_voxels.hpp"

namespace voxdag {

/// Imports a source that has splats: import_voxels() calls it. The grid is placed around the boxes
/// of the splats. Reads the file once or twice. Memory is bounded: splats that do not fit are
/// sorted in a file, and colours go through another one. Throws Error, OverMemory and Cancelled.
ImportResult import_splats(const VoxelSource& source, const ImportOptions& options, Work work);

}  // namespace voxdag
