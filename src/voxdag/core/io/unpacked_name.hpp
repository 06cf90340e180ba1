#pragma once
/// Names of compressed files.
#include <filesystem>

#include "voxdag/core/lower_case.hpp"

namespace voxdag {

/// Returns the name without its ending .gz or .zst, in any case. What is left tells the format.
inline std::filesystem::path unpacked_name(const std::filesystem::path& name) {
  const std::string ending = lower_case(name.extension().string());
  return ending == ".gz" || ending == ".zst" ? name.parent_path() / name.stem() : name;
}

}  // namespace voxdag
