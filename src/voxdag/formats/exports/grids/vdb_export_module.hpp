#pragma once
/// The interface of the module that writes .vdb and .nvdb files. Programs load the module when they
/// write such a file (see formats/imports/volumes/vdb_module.hpp).
#include "voxdag/formats/exports/export_options.hpp"

namespace voxdag {

struct VdbExportModule {
  void (*write)(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                const Box3i& window, const ExportOptions& options);
};

/// The name of its file, and of the VdbExportModule in it.
inline constexpr const char* kVdbExportModuleFile = "voxdag_vdb_export.so";
inline constexpr const char* kVdbExportModuleName = "voxdag_vdb_export_module";

}  // namespace voxdag
