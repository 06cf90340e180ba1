#pragma once
/// Finds the meshes that a glTF scene shows, and their transforms.
#include <cstdint>

#include "voxdag/formats/readers/gltf/gltf_file.hpp"
#include "voxdag/formats/readers/gltf/gltf_transform.hpp"

namespace voxdag {

struct GltfInstance {
  std::uint32_t mesh;  ///< Index into the array `meshes`.
  GltfTransform transform;
};

/// Returns the instances of the default scene. Without a default scene, returns those of the first
/// scene; without scenes, those of all root nodes; without nodes, every mesh once. Throws Error if
/// nodes do not form trees, OverMemory, Cancelled.
CountedVector<GltfInstance> find_gltf_instances(const GltfFile& file);

}  // namespace voxdag
