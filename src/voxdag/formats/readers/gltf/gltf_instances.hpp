#pragma once
/// Finds the meshes that a glTF scene shows, and their transforms.
#include <array>
#include <cstdint>

#include "voxdag/core/vec.hpp"
#include "voxdag/formats/readers/gltf/gltf_accessor.hpp"
#include "voxdag/formats/readers/gltf/gltf_file.hpp"
#include "voxdag/formats/readers/warnings.hpp"

namespace voxdag {

/// An affine map: columns x, y, z and the translation.
struct GltfTransform {
  std::array<Vec3d, 4> columns{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}};

  Vec3d direction(Vec3d v) const { return columns[0] * v.x + columns[1] * v.y + columns[2] * v.z; }
  Vec3d point(Vec3d p) const { return direction(p) + columns[3]; }
  /// Returns whether the map turns left into right, so that it turns triangles over.
  bool is_mirroring() const { return dot(columns[0], cross(columns[1], columns[2])) < 0; }
  /// Maps a normal with the inverse transpose, up to a positive factor. Returns zero if the map
  /// flattens space to less than a plane.
  Vec3d normal(Vec3d n) const {
    const Vec3d x = cross(columns[1], columns[2]), y = cross(columns[2], columns[0]),
                z = cross(columns[0], columns[1]);
    const Vec3d mapped = x * n.x + y * n.y + z * n.z;
    return dot(columns[0], x) < 0 ? -mapped : mapped;
  }
  friend GltfTransform operator*(const GltfTransform& a, const GltfTransform& b) {
    return {{a.direction(b.columns[0]), a.direction(b.columns[1]), a.direction(b.columns[2]),
             a.point(b.columns[3])}};
  }
};

struct GltfInstance {
  std::uint32_t mesh;  ///< Index into the array `meshes`.
  std::uint32_t node;  ///< Index into the array `nodes`; kGltfNoNode: the asset has none.
  GltfTransform transform;
};
inline constexpr std::uint32_t kGltfNoNode = ~std::uint32_t{0};

struct GltfScene {
  explicit GltfScene(MemoryBudget* memory) : instances(memory), nodes(memory), is_shown(memory) {}

  CountedVector<GltfInstance> instances;
  CountedVector<GltfTransform> nodes;  ///< World transforms, if the asset has skins.
  CountedVector<char> is_shown;        ///< Whether a node is in the scene.
};

/// Returns the instances of the default scene: the nodes' meshes, once per instance of
/// EXT_mesh_gpu_instancing. Without a default scene, returns those of the first scene; without
/// scenes, those of all root nodes; without nodes, every mesh once. Leaves out what
/// KHR_node_visibility hides. Warns of matrices whose last row is not exactly 0 0 0 1. Throws Error
/// if nodes do not form trees, OverMemory, Cancelled.
GltfScene find_gltf_scene(const GltfFile& file, GltfAccessors& accessors, Warnings& warnings);

}  // namespace voxdag
