#pragma once
/// Exports voxels to the format that the extension of the output names.
#include "voxdag/exports/export_options.hpp"

namespace voxdag {

enum class PlyContent { kPoints, kFaces };

/// Returns whether export_voxels() knows the extension of `path`.
bool can_export_to(const std::filesystem::path& path);

/// Chooses the format by the extension: .npy (dense if there is a window, else coordinates), .ply,
/// .raw.
void export_voxels(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                   PlyContent ply_content, const ExportOptions& options = {});

}  // namespace voxdag
