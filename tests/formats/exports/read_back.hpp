#pragma once
/// Reads exported files with the importers, which have tests of their own.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "colored_scene.hpp"
#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

using ColoredVoxels = std::map<VoxelKey, Rgb8>;

/// Reads a file with the importers, by its own coordinates. Voxels without colour are black.
inline ColoredVoxels read_back(const std::filesystem::path& path, Vec3i moved_by = {}) {
  ColoredVoxels voxels;
  open_voxel_source(path, {.threshold = {}, .use_placement = false})
      ->visit_all([&](const VoxelBatch& batch) {
        for (std::size_t i = 0; i < batch.places.size(); ++i) {
          const Vec3i v = Vec3i(batch.places[i]) + moved_by;
          EXPECT_TRUE(
              voxels.try_emplace({v.x, v.y, v.z}, batch.colors.empty() ? Rgb8{} : batch.colors[i])
                  .second);
        }
      });
  return voxels;
}

inline bool is_inside(Vec3i v, const Box3i& box) {
  return v.x >= box.lo.x && v.y >= box.lo.y && v.z >= box.lo.z && v.x < box.hi.x &&
         v.y < box.hi.y && v.z < box.hi.z;
}

/// Returns the voxels of a scene in a box, black.
inline ColoredVoxels voxels_of(const ExportedScene& scene, const Box3i& box) {
  ColoredVoxels voxels;
  for (const Vec3i v : scene.voxels)
    if (is_inside(v, box)) voxels[{v.x, v.y, v.z}] = {};
  return voxels;
}
inline ColoredVoxels colored_voxels_of(const ColoredScene& scene, const Box3i& box) {
  ColoredVoxels voxels;
  for (const Vec3i v : scene.voxels) {
    const Value8 color = scene.value(v);
    if (is_inside(v, box)) voxels[{v.x, v.y, v.z}] = {color.x, color.y, color.z};
  }
  return voxels;
}

/// A window that is not aligned with blocks or cells.
inline constexpr Box3i kWindow{{3, 1, 6}, {29, 32, 13}};

}  // namespace voxdag
