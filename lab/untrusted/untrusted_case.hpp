#pragma once
/// The cases of `voxdag bench untrusted`: inputs that cost much for their size, or that name files
/// they must not read.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace voxdag::lab {

/// One hostile input and the command that reads it.
struct UntrustedCase {
  std::string name;
  /// Writes the input files, and any other files that the case needs, into an empty folder.
  std::function<void(const std::filesystem::path& folder)> write;
  /// Arguments of a voxdag command that runs first and is not measured; empty: none.
  std::vector<std::string> setup;
  /// Arguments of the measured voxdag command; paths are relative to the folder.
  std::vector<std::string> command;
  std::uint64_t memory_limit = 0;  ///< Bytes that `command` gives by --memory; 0: no such option.
  /// The exit status that docs/security.md promises; -1: 0 or 1.
  int status = -1;
};

/// Returns the cases with meshes and the files that they name.
std::vector<UntrustedCase> untrusted_mesh_cases();
/// Returns the cases with textures.
std::vector<UntrustedCase> untrusted_image_cases();
/// Returns the cases with voxel files, camera paths, and names of files outside the input's folder.
std::vector<UntrustedCase> untrusted_file_cases();

}  // namespace voxdag::lab
