#pragma once
/// Exports voxels as PLY: their centres, or the outer faces of their cubes.
#include "voxdag/formats/exports/export_options.hpp"

namespace voxdag {

/// Writes voxel centres in world units, in Morton order, as binary little-endian PLY. Coordinates
/// are float if that is exact to 1/16 voxel over the whole grid, else double. Normals (nx, ny, nz),
/// colours (red, green, blue: 8 bits, sRGB) and the number of the material (material: 16 bits)
/// follow if the look has them.
void export_ply_points(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                       const ExportOptions& options = {});

/// Writes the voxels of the window as cubes in world units, as PLY: a quad, counter-clockwise from
/// outside, for each face whose neighbour is not a voxel of the window. Quads share corners within
/// a leaf block of 4³. With a look, they share corners only within a voxel, and each corner has the
/// attributes of that voxel. Smooth faces (FaceMesh::kSmooth) are triangles that share their
/// corners, if there is no look. Coordinates are as in export_ply_points(); at most 2^31 - 1
/// corners.
void export_ply_faces(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                      const ExportOptions& options = {});

}  // namespace voxdag
