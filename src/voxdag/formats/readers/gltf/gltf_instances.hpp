#pragma once
/// Finds the meshes that a glTF scene shows, and their transforms.
#include <array>
#include <cstdint>
#include <optional>

#include "voxdag/core/vec.hpp"
#include "voxdag/formats/readers/gltf/gltf_file.hpp"
#include "voxdag/formats/readers/gltf/gltf_value.hpp"

namespace voxdag {

/// An affine map: columns x, y, z and the translation.
struct GltfTransform {
  std::array<Vec3d, 4> columns{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}};

  Vec3d direction(Vec3d v) const { return columns[0] * v.x + columns[1] * v.y + columns[2] * v.z; }
  Vec3d point(Vec3d p) const { return direction(p) + columns[3]; }
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

/// Returns the transform of a node from its matrix or its translation, rotation and scale. Throws
/// Error.
GltfTransform gltf_node_transform(const GltfValue& node);

struct GltfInstance {
  std::uint32_t mesh;  ///< Index into the array `meshes`.
  GltfTransform transform;
  std::optional<std::uint64_t> node = {};  ///< Index into the array `nodes`.
};

/// Returns the instances of the default scene. Without a default scene, returns those of the first
/// scene; without scenes, those of all root nodes; without nodes, every mesh once. Throws Error if
/// nodes do not form trees, OverMemory, Cancelled.
CountedVector<GltfInstance> find_gltf_instances(const GltfFile& file);

}  // namespace voxdag
