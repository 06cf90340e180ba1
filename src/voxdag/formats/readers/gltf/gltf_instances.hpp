#pragma once
/// Finds the meshes that a glTF scene shows, and their transforms.
#include <cstdint>

#include "voxdag/formats/readers/affine_transform.hpp"
#include "voxdag/formats/readers/gltf/gltf_accessor.hpp"
#include "voxdag/formats/readers/gltf/gltf_file.hpp"
#include "voxdag/formats/readers/warnings.hpp"

namespace voxdag {

struct GltfInstance {
  std::uint32_t mesh;  ///< Index into the array `meshes`.
  std::uint32_t node;  ///< Index into the array `nodes`; kGltfNoNode: the asset has none.
  AffineTransform transform;
};
inline constexpr std::uint32_t kGltfNoNode = ~std::uint32_t{0};

struct GltfScene {
  explicit GltfScene(MemoryBudget* memory) : instances(memory), nodes(memory), is_placed(memory) {}

  CountedVector<GltfInstance> instances;
  CountedVector<AffineTransform> nodes;  ///< World transforms, if the asset has skins.
  CountedVector<char> is_placed;         ///< Whether a node is in the scene, or `nodes` has it.
};

/// Returns the instances of the default scene: the nodes' meshes, once per instance of
/// EXT_mesh_gpu_instancing. Without a default scene, returns those of the first scene; without
/// scenes, those of all root nodes; without nodes, every mesh once. Leaves out what
/// KHR_node_visibility hides. Warns of matrices whose last row is not exactly 0 0 0 1. Throws Error
/// if nodes do not form trees, OverMemory, Cancelled.
GltfScene find_gltf_scene(const GltfFile& file, GltfAccessors& accessors, Warnings& warnings);

}  // namespace voxdag
