#pragma once
#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

/// Opens a volume of NIfTI-1 or NIfTI-2 in one file, also compressed with gzip: integers, float32,
/// float64, RGB24 and RGBA32. A threshold is compared with the scaled values (scl_slope and
/// scl_inter). An RGBA voxel is set by its alpha, an RGB voxel by the greatest of its channels. Of
/// a file with several volumes only the first one is read. The place comes from the sform, else
/// from the qform; both hold centres of voxels. Lengths are in the unit of the file.
std::unique_ptr<VoxelSource> open_nifti(const std::filesystem::path& path,
                                        std::optional<double> threshold);

}  // namespace voxdag
