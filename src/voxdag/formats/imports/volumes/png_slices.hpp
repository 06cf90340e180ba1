#pragma once
#include <string_view>

#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

/// Opens a folder of PNG files of one size as a volume. The files whose names end in .png and do
/// not begin with a dot are sorted by name, numbers by their value: slice_9.png comes before
/// slice_10.png. File k, counted from 0, has the voxels (x, y, k): x counts pixels from the left, y
/// from the top.
///
/// A grey pixel sets its voxel if its value is at least the threshold, or not 0 without one; if it
/// has alpha, alpha must not be 0 either. An RGB pixel has the greatest of its channels as value,
/// an RGBA pixel its alpha. Values are 0 to 255, or 0 to 65535 in files of 16 bits. The volume has
/// colours if the first slice has; all slices are grey if the first one is. Images are decoded one
/// at a time.
std::unique_ptr<VoxelSource> open_png_slices(const std::filesystem::path& folder,
                                             std::optional<double> threshold);

/// Returns whether the name `a` comes before `b` if numbers in them are compared by value.
bool is_before_by_numbers(std::string_view a, std::string_view b);

}  // namespace voxdag
