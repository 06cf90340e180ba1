#pragma once
/// What the module for .vdb files has. Programs load it when they open such a file: OpenVDB and
/// what it needs take 50 MB and a tenth of a second to start.
#include "voxdag/imports/voxel_source.hpp"

namespace voxdag {

struct VdbModule {
  VoxelSource* (*open)(const std::filesystem::path& path, std::optional<double> threshold);
};

/// The name of its file, and of the VdbModule in it.
inline constexpr const char* kVdbModuleFile = "voxdag_vdb.so";
inline constexpr const char* kVdbModuleName = "voxdag_vdb_module";

}  // namespace voxdag
