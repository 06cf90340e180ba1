#pragma once
/// Exports voxels to the format that the extension of the output names.
#include <vector>

#include "voxdag/formats/exports/export_options.hpp"

namespace voxdag {

/// Returns whether export_voxels() knows the extension of `path`.
bool can_export_to(const std::filesystem::path& path);
/// Returns the extensions that export_voxels() knows: ".npy, .ply, ... or .glb".
std::string export_extensions();

/// Throws Error unless `path` may be the name of a .vdag file: if it ends in .esvo or .html, or in
/// an extension that export_voxels() knows.
void check_vdag_name(const std::filesystem::path& path);

/// Chooses between contents of one extension.
struct ExportContent {
  bool ply_faces = false;  ///< For .ply: outer faces, not points.
  std::string format =
      {};  ///< The extension that tells the format, "glb"; empty: that of the path.
  std::optional<char> up = {};  ///< For export_scene(): the axis that points up, 'y' or 'z'.
};

/// Chooses the format by content.format or the extension, in letters of either case: .npy (dense if
/// there is a window, else coordinates), .raw, .spc.npy, .ply, .glb, .obj, .stl, .3mf, .vox,
/// .binvox, .schem, .voxel.json, .vdb, .nvdb. Returns the files with voxels that were written: more
/// than one only for .vox.
std::vector<std::filesystem::path> export_voxels(const std::filesystem::path& path,
                                                 const VoxelSet& voxels, const Grid& grid,
                                                 const ExportContent& content = {},
                                                 const ExportOptions& options = {});

/// Returns the axis that points up in files of the format by its custom, 'y' or 'z'; nothing if it
/// has none.
std::optional<char> custom_up(const std::filesystem::path& path, const ExportContent& content);

/// Returns whether export_voxels() writes colours to this file, if there are some.
bool export_has_colors(const std::filesystem::path& path, bool has_window);

}  // namespace voxdag
