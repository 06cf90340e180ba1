#include "voxdag/exports/export_voxels.hpp"

#include "voxdag/core/error.hpp"
#include "voxdag/exports/export_arrays.hpp"
#include "voxdag/exports/export_ply.hpp"

namespace voxdag {

bool can_export_to(const std::filesystem::path& path) {
  const std::filesystem::path extension = path.extension();
  return extension == ".npy" || extension == ".ply" || extension == ".raw";
}

void export_voxels(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                   PlyContent ply_content, const ExportOptions& options) {
  const std::filesystem::path extension = path.extension();
  if (!can_export_to(path))
    throw Error(
        path.string(), "",
        "cannot export to '" + extension.string() + "': the extension must be .npy, .ply or .raw");
  if (extension == ".npy" && options.window) return export_npy_dense(path, voxels, grid, options);
  if (extension == ".npy") return export_npy_coordinates(path, voxels, grid, options);
  if (extension == ".raw") return export_raw(path, voxels, grid, options);
  if (extension == ".ply" && ply_content == PlyContent::kFaces)
    return export_ply_faces(path, voxels, grid, options);
  export_ply_points(path, voxels, grid, options);
}

}  // namespace voxdag
