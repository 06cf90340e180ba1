#pragma once
/// A visible point of a surface, ready to be shaded.
#include <cmath>

#include "voxdag/core/vec.hpp"

namespace voxdag {

/// The result of a primary ray at the voxels, or at a mesh (the voxels then compute only the
/// light).
struct ViewSample {
  Vec3d point{};   ///< World space.
  Vec3f normal{};  ///< For shading: unit length, towards the viewer; zero where nothing was hit.
  Vec3f face{};    ///< Normal of the face: unit length, towards the viewer.
  Vec3f albedo{};  ///< Linear, in [0,1].
  float depth = HUGE_VALF;  ///< World units along the camera's axis.
  float cell_size = 0;      ///< Side of the cell hit, world units: the error of the voxels.
  /// Side of the cells that represent a surface at this depth; rays from here may end at such
  /// cells. 0 means cell_size.
  float detail_size = 0;
  /// The height above the point, along `face`, at which rays start, in world units. 0 means just
  /// above the cubes of cell_size that may represent the surface.
  float lift = 0;
  float ground = 0;  ///< Of the ground, see ground.hpp: opacity of a full shadow; 0: a surface.

  VOXDAG_HD bool is_hit() const { return depth < HUGE_VALF; }
};

}  // namespace voxdag
