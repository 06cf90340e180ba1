#pragma once
/// Light that is baked into colours: how much of it reaches places on the surface.
#include <functional>

#include "voxdag/core/vec.hpp"

namespace voxdag {

struct SurfacePlace {
  Vec3d point;     ///< In voxels of the finest level, from the grid's lower corner.
  Vec3f normal{};  ///< Unit length, as it will be seen.
  Vec3f face{};    ///< Unit length, of the triangle itself, on the same side as `normal`.
};

/// The part of the light that arrives, 0 to 1. Called by several threads at a time; what it returns
/// depends on the place alone.
using SurfaceLight = std::function<float(const SurfacePlace&)>;

}  // namespace voxdag
