#pragma once
/// The light that a build bakes into colours.
#include <functional>

#include "voxdag/core/vec.hpp"

namespace voxdag {

/// A point on the surface.
struct SurfacePlace {
  Vec3d point;     ///< In voxels of the finest level, from the grid's lower corner.
  Vec3f normal{};  ///< Unit length; the shading normal.
  Vec3f face{};    ///< Unit length; triangle normal, on the side of `normal`.
};

/// Returns the fraction of the light that reaches a point, 0 to 1. Several threads call it
/// concurrently; the result must depend on the argument alone.
using SurfaceLight = std::function<float(const SurfacePlace&)>;

}  // namespace voxdag
