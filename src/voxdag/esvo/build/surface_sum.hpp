#pragma once
/// Area-weighted sums over the surface in a voxel: the stored colour and normal are their means.
#include "voxdag/core/vec.hpp"
#include "voxdag/esvo/encode/esvo_tree.hpp"

namespace voxdag {

struct SurfaceSum {
  Vec3f color{};   ///< Linear light times area.
  Vec3f normal{};  ///< Normals times area.
  float area = 0;  ///< Visible area, in voxels² of the finest level.

  /// Adds other surface. The normals of the two sides of something thin would cancel: one that
  /// points the other way is negated first, because a viewer sees one side at a time.
  void add(const SurfaceSum& other) {
    const float along = dot(normal, other.normal);
    const bool is_opposite =
        along < 0 && 4 * along * along > dot(normal, normal) * dot(other.normal, other.normal);
    color = color + other.color;
    normal = is_opposite ? normal - other.normal : normal + other.normal;
    area += other.area;
  }
};

/// Returns the means as a voxel stores them. A voxel whose normals cancel gets an arbitrary normal.
VoxelValue voxel_value(const SurfaceSum& sum);

}  // namespace voxdag
