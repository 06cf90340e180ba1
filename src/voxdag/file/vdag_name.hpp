#pragma once
/// Refuses names of other formats for .vdag files.
#include <filesystem>

namespace voxdag {

/// Throws Error if the name ends in an extension of the files that `voxdag export` writes (.glb,
/// .npy, .html), or in .esvo. Every other ending is allowed, and none.
void check_vdag_name(const std::filesystem::path& path);

}  // namespace voxdag
