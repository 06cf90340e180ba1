#pragma once
/// Writes the page with its scene for other servers, or as one file that needs none.
#include <cstdint>
#include <filesystem>

#include "viewer/scene/scene_bytes.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

/// A page in one file is easy to open and to send up to about this size.
inline constexpr std::uint64_t kHandyPageBytes = std::uint64_t{64} << 20;

/// Writes a folder with the page's files and "scene.vdag", complete or not at all: a folder beside
/// it gets its name at last. An existing folder is replaced if it has no other files than these.
/// Returns the bytes of all files. Throws Error, and Cancelled; `progress` may be null.
std::uint64_t export_site(const std::filesystem::path& folder, const SceneBytes& scene,
                          Progress* progress);

/// Writes the page of make_single_page() with the scene, complete or not at all. The file depends
/// on the scene's bytes alone. Returns its size. Throws Error, and Cancelled; `progress` may be
/// null.
std::uint64_t export_single_page(const std::filesystem::path& file, const SceneBytes& scene,
                                 Progress* progress);

}  // namespace voxdag
