#pragma once
/// The interface of the module that reads .vdb files. Programs load the module when they open such
/// a file: OpenVDB and its libraries take 30 MB of memory and 0.08 s to load.
#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

struct VdbModule {
  VoxelSource* (*open)(const std::filesystem::path& path, std::optional<double> threshold,
                       const std::string& grid, bool has_labels,
                       const std::vector<ChannelRequest>& channels);
};

/// The name of its file, and of the VdbModule in it.
inline constexpr const char* kVdbModuleFile = "voxdag_vdb.so";
inline constexpr const char* kVdbModuleName = "voxdag_vdb_module";

}  // namespace voxdag
