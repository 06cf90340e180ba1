#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/load_module.hpp"
#include "voxdag/formats/imports/labels/label_value.hpp"
#include "voxdag/formats/imports/volumes/vdb_module.hpp"
#include "voxdag/formats/imports/volumes/volume_sources.hpp"

namespace voxdag {
std::unique_ptr<VoxelSource> open_vdb(const std::filesystem::path& path,
                                      std::optional<double> threshold, const std::string& grid,
                                      const LabelRequest& labels,
                                      const std::vector<ChannelRequest>& channels) {
  std::string reason;
  const auto* const module =
      static_cast<const VdbModule*>(load_module(kVdbModuleFile, kVdbModuleName, reason));
  if (module == nullptr)
    throw Error(path.string(), "",
                "is read by a module that is built where OpenVDB is installed: " + reason);
  return std::unique_ptr<VoxelSource>(
      module->open(path, threshold, grid, wants_labels(labels), channels));
}

}  // namespace voxdag
