#pragma once
/// The settings that shape an ESVO.
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

struct EsvoSettings {
  bool contours = true;  ///< False: leaves are cubes of the finest level.
  /// The distance that a leaf's shape may reach beyond the surface, in voxels of the finest level.
  float max_error = 0.5f;
  /// The difference allowed between a leaf's points and its mean colour: the maximum over the
  /// channels, sRGB encoded, 0 to 1.
  float color_error = 0.03f;
  /// The angle allowed between normals in a leaf and its mean normal, in radians.
  float normal_error = 0.05f;
  bool attributes = true;  ///< Store colours and normals.
  /// The light to bake into the colours of leaves, or empty. Where it varies by more than
  /// `color_error`, leaves are of the finest level.
  SurfaceLight light;
};

}  // namespace voxdag
