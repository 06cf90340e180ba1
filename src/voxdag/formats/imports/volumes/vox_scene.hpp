#pragma once
/// Places the models of a .vox file by its scene graph.
#include <cstdint>
#include <filesystem>
#include <vector>

#include "voxdag/formats/imports/volumes/vox_file.hpp"

namespace voxdag {

/// A model in the scene.
struct VoxInstance {
  std::uint32_t model = 0;
  VoxRotation rotation;
  Vec3i translation;

  /// Returns where a voxel of a model of this size lies in the scene. The pivot is the corner of
  /// the model's voxels at half of its size, rounded down. A mirrored voxel begins where its upper
  /// side was.
  Vec3l place(Vec3i voxel, Vec3i size) const {
    Vec3l placed;
    for (int row = 0; row < 3; ++row) {
      const int axis = rotation.axis[static_cast<std::size_t>(row)];
      const std::int64_t from_pivot = std::int64_t{voxel[axis]} - size[axis] / 2;
      const bool is_negative = rotation.is_negative[static_cast<std::size_t>(row)];
      placed[row] = (is_negative ? -from_pivot - 1 : from_pivot) + translation[row];
    }
    return placed;
  }
};

/// Returns all visible models of the scene, from node 0 on. A file without a scene has all models
/// with their corner at 0. Throws Error for a graph that is not a tree or DAG of nodes, and if it
/// has more than 1,048,576 instances or is deeper than 1000 nodes.
std::vector<VoxInstance> place_models(const std::filesystem::path& path, const VoxFile& file);

}  // namespace voxdag
