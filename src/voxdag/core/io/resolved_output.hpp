#pragma once
/// Finds the file or descriptor that an output path names.
#include <filesystem>

namespace voxdag {

struct ResolvedOutput {
  std::filesystem::path file;  ///< The path with symbolic links followed; need not exist.
  int descriptor = -1;         ///< A descriptor of this process (/dev/stdout), or -1.
  int error = 0;  ///< The system's error if links form a loop or cannot be read; else 0.
};

ResolvedOutput resolve_output(const std::filesystem::path& path);

/// Returns the path by which resolve_output() finds a descriptor of this process.
std::filesystem::path output_path_of(int descriptor);

}  // namespace voxdag
