#pragma once
/// Finds vertices that no triangle may use.
#include <cstdint>
#include <optional>

#include "voxdag/formats/readers/mesh_source.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

inline constexpr const char* kBadVertex = "vertex is not finite and a face uses it";

/// Returns the index of the first vertex that a triangle uses and that is not finite. Throws
/// Cancelled.
inline std::optional<std::size_t> find_bad_vertex(const MeshSource& source, const Mesh& mesh) {
  CancelPoll poll(source.work());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    poll.step();
    if ((t + 1) % 65536 == 0) source.count_work(65536 * sizeof(Triangle));
    for (const std::uint32_t index : mesh.triangles[t])
      if (!is_finite(mesh.vertices[index])) return index;
  }
  return std::nullopt;
}

}  // namespace voxdag
