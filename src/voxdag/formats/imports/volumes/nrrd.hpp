#pragma once
#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

/// Opens a volume of NRRD, with its data in the same file or in one of the same folder: raw, gzip,
/// ascii or hex. The first axis is x. A first axis of 3 or 4 values of uint8 is a colour: an RGBA
/// voxel is set by its alpha, an RGB voxel by the greatest of its channels. The space origin is the
/// centre of voxel (0, 0, 0). Format: see nrrd_header.hpp.
std::unique_ptr<VoxelSource> open_nrrd(const std::filesystem::path& path,
                                       std::optional<double> threshold);

}  // namespace voxdag
