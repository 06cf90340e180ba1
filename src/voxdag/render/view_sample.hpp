#pragma once
/// A point of a surface that a picture shows: what is shaded, whatever found it.
#include <cmath>

#include "voxdag/core/vec.hpp"

namespace voxdag {

/// Made by the primary rays of the voxels, or by a mesh whose light the voxels cast.
struct ViewSample {
  Vec3d point{};   ///< World space.
  Vec3f normal{};  ///< For shading: unit length, towards the viewer; zero where nothing is.
  Vec3f face{};    ///< Of the flat piece of surface itself: likewise.
  Vec3f albedo{};  ///< Linear, in [0,1].
  float depth = HUGE_VALF;  ///< World units along the camera's axis.
  float cell_size = 0;      ///< Side of the cell met, world units: how far the voxels are off.
  /// Side of the cells that stand for a surface at this depth, at which rays from here may end; 0:
  /// cell_size.
  float detail_size = 0;
  /// How far above the point, along `face`, rays start, world units; 0: above the cubes of
  /// cell_size that may stand for the surface.
  float lift = 0;

  VOXDAG_HD bool is_hit() const { return depth < HUGE_VALF; }
};

}  // namespace voxdag
