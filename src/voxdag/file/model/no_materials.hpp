#pragma once
/// The error of DAGs and ESVOs without material ids.
#include <filesystem>

#include "voxdag/core/error.hpp"

namespace voxdag {

[[noreturn]] inline void fail_without_materials(const std::filesystem::path& path) {
  throw Error(path.string(), "", "has no material ids: voxdag build --material-ids stores them");
}

}  // namespace voxdag
