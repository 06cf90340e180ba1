#pragma once
#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

/// Opens a text of points: three numbers in each line, and perhaps more that are ignored. Blanks,
/// tabs, commas or semicolons separate them; # begins a comment. At most 1 MiB per line.
std::unique_ptr<VoxelSource> open_xyz_points(const std::filesystem::path& path);

}  // namespace voxdag
