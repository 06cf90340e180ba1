#pragma once
#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

/// Opens the points of a PCD file, versions 0.5 to 0.7, with DATA ascii, binary or
/// binary_compressed. x, y and z may have any type; numbers of text are float64. Points whose
/// coordinates are not finite are the holes of an organised cloud: they are left out silently. The
/// viewpoint is ignored.
///
/// The colours are field `rgb` or `rgba` of 4 bytes: 0xAARRGGBB, also as the bits of a float. In
/// text, a number with only digits is that integer; any other number is such a float, and NaN is
/// black. Fields of other sizes are no colours.
///
/// Memory is bounded, also for compressed files, which hold one field of all points after another.
/// Throws Error with the line or byte: malformed headers and values, counts that need a longer
/// file, compressed data that is damaged or that promises more than LZF can hold.
std::unique_ptr<VoxelSource> open_pcd_points(const std::filesystem::path& path);

}  // namespace voxdag
