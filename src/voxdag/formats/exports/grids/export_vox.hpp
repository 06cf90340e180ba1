#pragma once
/// Exports voxels as MagicaVoxel scenes.
/// Source: ephtracy, "MagicaVoxel .vox File Format" and its extension for scenes, version 200.
#include <vector>

#include "voxdag/formats/exports/export_options.hpp"

namespace voxdag {

/// Writes models of up to 256³ voxels and a scene that puts them together. The axes stay as they
/// are, so z is up. The scene is centred along x and y, and stands on the ground, z = 0, if it is
/// not higher than 1000 voxels; else it is centred along z too.
///
/// MagicaVoxel shows positions from -1000 to 999. A longer window is cut into sections of up to
/// 2000³ voxels: that with number (a, b, c) along the axes goes to NAME-a-b-c.vox, if it has
/// voxels. Their first voxels lie at (-1000, -1000, -1000). All files appear at the end. Returns
/// the files that were written, PATH alone if there is one section. The placement goes to
/// PATH.json.
///
/// With a look that has colours, the palette has up to 255 of them, chosen for the whole window
/// (color_palette.hpp). Else all voxels are grey. Throws Error if a section has more than
/// 500,000,000 voxels, because sizes in the file have 32 bits, or if there are more than 500.
std::vector<std::filesystem::path> export_vox(const std::filesystem::path& path,
                                              const VoxelSet& voxels, const Grid& grid,
                                              const ExportOptions& options = {});

}  // namespace voxdag
