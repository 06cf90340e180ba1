#pragma once
/// The settings that shape an ESVO.
#include "voxdag/esvo/build/surface_light.hpp"

namespace voxdag {

struct EsvoSettings {
  bool contours = true;  ///< False: leaves are cubes of the finest level.
  /// How far a leaf's shape may reach beyond the surface, in voxels of the finest level.
  float max_error = 0.5f;
  /// How much a leaf's points may differ from its mean colour: the greatest difference of a
  /// channel, sRGB encoded, 0 to 1.
  float color_error = 0.03f;
  /// How much the normals of a leaf's points may differ from its mean normal, in radians.
  float normal_error = 0.05f;
  bool attributes = true;  ///< Store colours and normals.
  /// The light to bake into the colours of leaves, or empty. Where it differs by more than
  /// `color_error`, leaves are of the finest level.
  SurfaceLight light;
};

}  // namespace voxdag
