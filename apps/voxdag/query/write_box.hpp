#pragma once
/// Writes the numbers of a box.
#include <string>
#include <vector>

#include "voxdag/core/grid.hpp"

namespace voxdag::cli {

/// Writes float32 values of the places of a box, of which x runs fastest, then y, then z: as a
/// volume if the name ends as VolumeFile says, else as a NumPy array of shape (nz, ny, nx). Throws
/// Error.
void write_box(const std::string& output, const Grid& grid, const Box3i& box,
               const std::vector<float>& values);

}  // namespace voxdag::cli
