#pragma once
/// Finds vertices that no triangle may use.
#include <cstdint>
#include <optional>

#include "voxdag/mesh/mesh.hpp"
#include "voxdag/readers/mesh_source.hpp"

namespace voxdag {

inline constexpr const char* kBadVertex = "vertex is not finite and a face uses it";

/// Returns the index of the first vertex that a triangle uses and that is not finite. Throws
/// Cancelled.
inline std::optional<std::size_t> find_bad_vertex(const Mesh& mesh, const Progress* progress) {
  CancelPoll poll(progress);
  for (const Triangle& triangle : mesh.triangles) {
    poll.step();
    for (const std::uint32_t index : triangle)
      if (!is_finite(mesh.vertices[index])) return index;
  }
  return std::nullopt;
}

}  // namespace voxdag
