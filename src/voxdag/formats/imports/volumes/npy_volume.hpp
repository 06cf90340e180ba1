#pragma once
#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

/// Opens an array of NumPy. Its shape decides: (N, 3) are points or voxels, as open_npy_points()
/// says. (X, Y, Z) is a volume of bools, integers, float32 or float64; element [x][y][z] belongs to
/// voxel (x, y, z). (X, Y, Z, 3) and (X, Y, Z, 4) of uint8 are a volume of colours: an RGBA voxel
/// is set by its alpha, an RGB voxel by the greatest of its channels. Volumes are in C or Fortran
/// order. Throws Error if a threshold is given for points.
std::unique_ptr<VoxelSource> open_npy(const std::filesystem::path& path,
                                      std::optional<double> threshold);

}  // namespace voxdag
