#pragma once
/// Reads a scene from its first byte to its last.
#include <algorithm>
#include <span>
#include <vector>

#include "viewer/scene/scene_bytes.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

/// Calls body(std::span<const std::byte>) for one piece of the bytes after the other. Throws Error
/// if the scene changes, and Cancelled.
template <class Body>
void for_each_piece(const SceneBytes& scene, Work work, const Body& body) {
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  std::vector<std::byte> piece(
      static_cast<std::size_t>(std::min<std::uint64_t>(scene.size(), kPiece)));
  for (std::uint64_t at = 0; at < scene.size();) {
    work.poll();
    work.report_done("export", at, scene.size());
    const auto part = std::span(piece).first(
        static_cast<std::size_t>(std::min<std::uint64_t>(kPiece, scene.size() - at)));
    if (!scene.read(at, part)) throw Error("the scene's file changed while it was read");
    body(std::span<const std::byte>(part));
    at += part.size();
  }
}

}  // namespace voxdag
