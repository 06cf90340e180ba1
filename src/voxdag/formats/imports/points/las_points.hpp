#pragma once
#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

/// Opens the points of a LAS file, versions 1.0 to 1.4, point formats 0 to 10. Skips points that
/// are flagged as withheld, which the specification calls deleted; reads synthetic points and all
/// others. Skips variable length records, and reads coordinates as they are, without a reference
/// system.
///
/// Formats 2, 3, 5, 7, 8 and 10 have colours. They have 16 bits, but many programs store 8: if no
/// component in the file exceeds 255, all have 8 bits; otherwise the upper 8 of 16 bits are read.
///
/// Throws Error with the byte: compressed files, malformed headers, counts that need a longer file.
std::unique_ptr<VoxelSource> open_las_points(const std::filesystem::path& path);

}  // namespace voxdag
