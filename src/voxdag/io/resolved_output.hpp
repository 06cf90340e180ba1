#pragma once
/// Where what is written to a path goes.
#include <filesystem>

namespace voxdag {

struct OutputPlace {
  std::filesystem::path file;  ///< The path with symbolic links followed, one to nothing too.
  int descriptor = -1;  ///< Where the path names a descriptor of this process (/dev/stdout): that.
  int error = 0;        ///< Of the system, where links go round or cannot be read; else 0.
};

OutputPlace output_place(const std::filesystem::path& path);

}  // namespace voxdag
