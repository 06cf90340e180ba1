#pragma once
/// Writes the page with its scene: a folder for any web server, or one file that needs no server.
#include <cstdint>
#include <filesystem>

#include "viewer/embedded/page_files.hpp"
#include "viewer/scene/scene_bytes.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

/// A page in one file of more bytes is slow to open and to send.
inline constexpr std::uint64_t kHandyPageBytes = std::uint64_t{64} << 20;

/// Writes a folder with the page's files and "scene.vdag", completely or not at all: it fills a
/// temporary folder, then renames it. Replaces an existing folder if that has no files but these.
/// Returns the bytes of all files. `files` are those of page_files(), or of a BakedPage. Throws
/// Error, and Cancelled. With NoScene, there is no "scene.vdag".
std::uint64_t export_site(const std::filesystem::path& folder, const SceneBytes& scene,
                          Work work = {}, std::span<const PageFile> files = page_files());

/// Writes the page of make_single_page() with the scene, completely or not at all. The bytes of the
/// file depend on the bytes of the scene and of `files` alone. Returns its size. Throws Error, and
/// Cancelled.
std::uint64_t export_single_page(const std::filesystem::path& file, const SceneBytes& scene,
                                 Work work = {}, std::span<const PageFile> files = page_files());

}  // namespace voxdag
