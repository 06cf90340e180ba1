#pragma once
/// Computes facts about a mesh: volume, closedness, hash.
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

inline bool is_sane(const Mesh& mesh) {
  for (const Vec3f& v : mesh.vertices)
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) return false;
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t index : t)
      if (index >= mesh.vertices.size()) return false;
  for (const std::uint32_t m : mesh.triangle_materials)
    if (m >= mesh.materials.size()) return false;
  return mesh.triangle_materials.size() == mesh.triangles.size();
}

inline Vec3d corner(const Mesh& mesh, std::size_t triangle, int i) {
  return static_cast<Vec3d>(mesh.vertices[mesh.triangles[triangle][static_cast<std::size_t>(i)]]);
}

inline std::size_t degenerate_count(const Mesh& mesh) {
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3d a = corner(mesh, t, 0);
    count += cross(corner(mesh, t, 1) - a, corner(mesh, t, 2) - a) == Vec3d{};
  }
  return count;
}

/// Returns the volume inside a closed surface whose triangles wind counter-clockwise seen from
/// outside.
inline double signed_volume(const Mesh& mesh) {
  double six_volumes = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    six_volumes += dot(corner(mesh, t, 0), cross(corner(mesh, t, 1), corner(mesh, t, 2)));
  return six_volumes / 6;
}

/// Returns whether every directed edge has an equal number of opposite edges.
inline bool is_closed(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      balance[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  for (const auto& [edge, count] : balance)
    if (count != 0) return false;
  return true;
}

/// Returns FNV-1a over vertices, indices and materials.
inline std::uint64_t hash_of(const Mesh& mesh) {
  std::uint64_t hash = 0xCBF29CE484222325ull;
  const auto add = [&hash](const void* data, std::size_t bytes) {
    const auto* p = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < bytes; ++i) hash = (hash ^ p[i]) * 0x100000001B3ull;
  };
  add(mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec3f));
  add(mesh.triangles.data(), mesh.triangles.size() * sizeof(Triangle));
  add(mesh.triangle_materials.data(), mesh.triangle_materials.size() * 4);
  return hash;
}

}  // namespace voxdag
