#pragma once
/// A mesh for tests of displacement.
#include <cstdint>
#include <memory>
#include <utility>

#include "voxdag/formats/scenes/stone_heights.hpp"
#include "voxdag/mesh/displace/displaced_triangles.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

inline std::shared_ptr<const HeightTexture> stones() {
  static const auto texture = std::make_shared<const HeightTexture>(make_stone_heights(1, 128));
  return texture;
}

/// A closed box of 12 triangles. Every face has its own vertices, and texture coordinates disagree
/// along the edges.
struct Crate {
  Mesh mesh;
  Appearance appearance;

  Crate() {
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) {
        const auto corner = [&](int u, int v) {
          constexpr Vec3f kSize{2, 1.5f, 1.25f};
          Vec3f p;
          p[axis] = static_cast<float>(side);
          p[(axis + 1) % 3] = static_cast<float>(side == 1 ? u : v);
          p[(axis + 2) % 3] = static_cast<float>(side == 1 ? v : u);
          return p * kSize;
        };
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
          mesh.vertices.push_back(corner(u, v));
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first, first + 2, first + 3});
        const float shift = 0.37f * static_cast<float>(first);
        for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}})
          appearance.uvs.push_back({static_cast<float>(u) + shift, static_cast<float>(v) * 0.8f});
      }
    appearance.materials.resize(2);
    mesh.materials = {"a", "b"};
    mesh.triangle_materials.assign(mesh.triangles.size(), 0);
  }
};

}  // namespace voxdag
