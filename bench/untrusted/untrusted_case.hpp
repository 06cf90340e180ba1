#pragma once
/// Inputs that cost much for their size, or ask for what they may not have: the cases of
/// `voxdag bench untrusted`.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace voxdag {

/// One hostile input and the command that gets it.
struct UntrustedCase {
  std::string name;
  /// Writes the input files into an empty folder, with files of its own choice beside them.
  std::function<void(const std::filesystem::path& folder)> write;
  /// Arguments of a voxdag command that runs first, untimed; empty: none.
  std::vector<std::string> setup;
  /// Arguments of the voxdag command that is measured; paths are relative to the folder.
  std::vector<std::string> command;
  std::uint64_t memory_limit = 0;  ///< Bytes that `command` gives by --memory; 0: no such option.
  /// The exit status that docs/security.md promises; -1: 0 or 1.
  int status = -1;
};

/// Meshes and what they name.
std::vector<UntrustedCase> untrusted_mesh_cases();
/// Textures.
std::vector<UntrustedCase> untrusted_image_cases();
/// Voxel files, camera paths, and names of files outside of the input's folder.
std::vector<UntrustedCase> untrusted_file_cases();

}  // namespace voxdag
