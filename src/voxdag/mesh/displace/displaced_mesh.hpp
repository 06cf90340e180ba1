#pragma once
/// A mesh with the displacement of each of its materials.
#include <array>
#include <cstdint>
#include <vector>

#include "voxdag/core/vec2.hpp"
#include "voxdag/mesh/appearance.hpp"
#include "voxdag/mesh/displace/displacement.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// The index 3 * triangle + corner of a corner, or of the edge from that corner to the next.
using CornerIndex = std::uint32_t;

constexpr CornerIndex next_corner(CornerIndex corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}

/// Refers to mesh and appearance, which must outlive it.
struct DisplacedMesh {
  const Mesh& mesh;
  const Appearance& appearance;
  std::vector<Displacement> displacements;  ///< One per material.

  const Displacement& displacement(std::uint32_t triangle) const {
    return displacements[Appearance::material_index(mesh, triangle)];
  }
  /// Returns whether the inside of a triangle moves.
  bool is_displaced(std::uint32_t triangle) const { return displacement(triangle).moves(); }

  /// Returns the normals of the corners: the triangle's own normal if the file does not give all
  /// three.
  std::array<Vec3f, 3> normals(std::uint32_t triangle) const;
  Vec2f uv(CornerIndex corner) const {
    return appearance.uvs.empty() ? Vec2f{} : appearance.uvs[corner];
  }
  /// Returns the position of a corner, from Mesh::origin.
  const Vec3f& position(CornerIndex corner) const {
    return mesh.vertices[mesh.triangles[corner / 3][corner % 3]];
  }
};

}  // namespace voxdag
