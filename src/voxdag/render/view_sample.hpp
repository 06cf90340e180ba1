#pragma once
/// A visible point of a surface, ready to be shaded.
#include <cmath>
#include <cstdint>

#include "voxdag/core/metallic_roughness.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {

/// A cell that a picture shows.
struct SeenCell {
  Vec3i voxel{-1, -1, -1};  ///< Its lowest voxel.
  std::int32_t level = -1;  ///< -1: none.

  friend bool operator==(const SeenCell&, const SeenCell&) = default;
};

/// The line along which a sample is seen, in world units: from the camera, or from a surface whose
/// light is wanted. A place on it is origin + t * direction.
struct SightLine {
  Vec3d origin, direction;
};

/// The result of a primary ray at the voxels, or at a mesh (the voxels then compute only the
/// light).
struct ViewSample {
  Vec3d point{};   ///< World space.
  Vec3f normal{};  ///< For shading: unit length, towards the viewer; zero where nothing was hit.
  Vec3f face{};    ///< Normal of the face: unit length, towards the viewer.
  Vec3f albedo{};  ///< Linear, in [0,1].
  MetallicRoughness metallic_roughness;
  float depth = HUGE_VALF;  ///< t along its line; the camera's: world units along its axis.
  float cell_size = 0;      ///< Side of the cell hit, world units: the error of the voxels.
  /// Side of the cells that represent a surface at this depth; rays from here may end at such
  /// cells. 0 means cell_size.
  float detail_size = 0;
  /// The height above the point, along `face`, at which rays start, in world units. 0 means just
  /// above the cubes of cell_size that may represent the surface.
  float lift = 0;
  SeenCell cell;     ///< The voxel or coarser cell that a ray at voxels hit.
  float ground = 0;  ///< Of the ground, see ground.hpp: opacity of a full shadow; 0: a surface.

  VOXDAG_HD bool is_hit() const { return depth < HUGE_VALF; }
};

}  // namespace voxdag
