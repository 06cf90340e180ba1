#pragma once
/// Opens files of points.
#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

/// The reason why a LAZ file is refused.
inline constexpr const char* kCompressedLas =
    "is a compressed LAS file (LAZ), which is not read: decompress it with laszip or PDAL";

/// Opens an array of NumPy: N × 3 int32 are voxels, N × 3 float32 or float64 are points.
std::unique_ptr<VoxelSource> open_npy_points(const std::filesystem::path& path);

/// Opens a text of points: three numbers in each line, and perhaps more that are ignored. Blanks,
/// tabs, commas or semicolons separate them; # begins a comment. At most 1 MiB per line.
std::unique_ptr<VoxelSource> open_xyz_points(const std::filesystem::path& path);

/// Opens the vertices of a PLY file as points, in ascii and in both binary orders; ignores faces
/// and other elements. Numbers of text are float64, whatever their type is called. The colours are
/// the properties that the mesh reader knows, with its scales: red, green and blue, or
/// diffuse_red ..., or r ...; integers up to the greatest value of 8 or 16 bits, or floats from 0
/// to 1, clamped.
///
/// Throws Error with the line (in a binary body with the byte): malformed headers and values,
/// counts that need a longer file, truncation before the end of the vertices, points that are not
/// finite.
std::unique_ptr<VoxelSource> open_ply_points(const std::filesystem::path& path);

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
