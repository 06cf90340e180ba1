#pragma once
/// Reads the placements that voxdag's exports write beside their files.
#include <memory>

#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

/// Returns the source with its voxels where FILE.json puts them, or placement.json in a folder of
/// slices, if voxdag wrote one (docs/export.md); else the source as it is. visit_all() throws Error
/// if a voxel lies outside of the window that the placement names: then it belongs to another file.
/// Throws Error if the placement is damaged.
std::unique_ptr<VoxelSource> with_file_placement(const std::filesystem::path& path,
                                                 std::unique_ptr<VoxelSource> source);

/// Returns whether the placement in a folder of slices says that the numbers in their names tell
/// their places: empty slices are left out.
bool has_numbered_slices(const std::filesystem::path& folder);

}  // namespace voxdag
