#pragma once
#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

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

}  // namespace voxdag
