#include "voxdag/imports/volumes/vdb.hpp"

#include <dlfcn.h>

#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/imports/volumes/vdb_module.hpp"

namespace voxdag {
namespace {

/// Returns the module, or null if it cannot be loaded; then `reason` tells why.
const VdbModule* load_module(std::string& reason) {
  void* const library = ::dlopen(kVdbModuleFile, RTLD_NOW | RTLD_LOCAL);
  const void* const module = library != nullptr ? ::dlsym(library, kVdbModuleName) : nullptr;
  if (module == nullptr) reason = ::dlerror();
  return static_cast<const VdbModule*>(module);
}

}  // namespace

std::unique_ptr<VoxelSource> open_vdb(const std::filesystem::path& path,
                                      std::optional<double> threshold) {
  std::string reason;
  const VdbModule* const module = load_module(reason);
  if (module == nullptr)
    throw Error(path.string(), "",
                "is read by a module that is built where OpenVDB is installed: " + reason);
  return std::unique_ptr<VoxelSource>(module->open(path, threshold));
}

}  // namespace voxdag
