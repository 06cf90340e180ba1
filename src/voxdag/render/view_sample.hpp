#pragma once
/// A visible point of a surface, ready to be shaded.
#include <cmath>

#include "voxdag/core/vec.hpp"

namespace voxdag {

/// Found by primary rays at the voxels, or at a mesh whose light the voxels compute.
struct ViewSample {
  Vec3d point{};   ///< World space.
  Vec3f normal{};  ///< For shading: unit length, towards the viewer; zero where nothing was hit.
  Vec3f face{};    ///< Normal of the face: unit length, towards the viewer.
  Vec3f albedo{};  ///< Linear, in [0,1].
  float depth = HUGE_VALF;  ///< World units along the camera's axis.
  float cell_size = 0;      ///< Side of the cell hit, world units: the error of the voxels.
  /// Side of the cells that represent a surface at this depth, at which rays from here may end; 0:
  /// cell_size.
  float detail_size = 0;
  /// How far above the point, along `face`, rays start, world units; 0: just above the cubes of
  /// cell_size that may represent the surface.
  float lift = 0;

  VOXDAG_HD bool is_hit() const { return depth < HUGE_VALF; }
};

}  // namespace voxdag
