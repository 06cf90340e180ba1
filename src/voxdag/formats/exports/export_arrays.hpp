#pragma once
/// Exports voxels as arrays: .npy and .raw.
#include "voxdag/formats/exports/export_options.hpp"

namespace voxdag {

/// Writes voxel coordinates in Morton order as .npy; with PATH.json. The array is N×3 int32. With a
/// look it is a structured array of shape (N,): voxel (int32 × 3), normal (float32 × 3), color
/// (uint8 × 3) and material (uint16), as far as the look has them.
void export_npy_coordinates(const std::filesystem::path& path, const VoxelSet& voxels,
                            const Grid& grid, const ExportOptions& options = {});

/// Writes a dense uint8 array as .npy: 1 for voxels that are set, else 0. Element [a, b, c] is
/// voxel window.lo + (a, b, c), in C order, so z changes fastest. With PATH.json.
void export_npy_dense(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                      const ExportOptions& options = {});

/// Writes a dense uint8 volume (VolumeFile): 1 for voxels that are set, else 0. `format` tells the
/// format as the ending of a name.
void export_volume(const std::filesystem::path& path, const std::string& format,
                   const VoxelSet& voxels, const Grid& grid, const ExportOptions& options);

/// Writes a dense array without a header, one byte per voxel: 1 for voxels that are set, else 0. x
/// changes fastest, then y, then z. With PATH.json.
void export_raw(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                const ExportOptions& options = {});

}  // namespace voxdag
