#include "voxdag/formats/exports/grids/export_vdb.hpp"

#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/load_module.hpp"
#include "voxdag/formats/exports/export_common.hpp"
#include "voxdag/formats/exports/grids/vdb_export_module.hpp"

namespace voxdag {

void export_vdb(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                const ExportOptions& options) {
  refuse_pipe(path);
  const Box3i window = export_window(path, voxels, options);
  std::string reason;
  const auto* const module = static_cast<const VdbExportModule*>(
      load_module(kVdbExportModuleFile, kVdbExportModuleName, reason));
  if (module == nullptr)
    throw Error(
        path.string(), "",
        "is written by a module that is built where OpenVDB and NanoVDB are installed: " + reason);
  module->write(path, voxels, grid, window, options);
}

}  // namespace voxdag
