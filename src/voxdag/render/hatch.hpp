#pragma once
/// Hatching of the faces at which a section cuts voxels: dark lines that keep their place in the
/// world while the camera moves. The page's sample.glsl is a port.
#include <cmath>

#include "voxdag/core/host_device.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {

/// The part of a period that is dark, the factor on the colour there, and how many periods the
/// height of the picture has at the depth of the target, rounded to a power of two of the side.
inline constexpr float kHatchWidth = 0.3f, kHatchShade = 0.55f, kHatchPeriods = 36;

/// Returns the period of the lines, in grid sides, for a picture that is `view_height` sides high
/// at the depth of its target.
inline float hatch_period(double view_height) {
  return static_cast<float>(std::exp2(std::round(std::log2(view_height / kHatchPeriods))));
}

/// Returns whether a point of a cut face is on a line. `place` is in grid sides from the grid's
/// corner. Lines run diagonally across the two axes that the normal points along least.
VOXDAG_HD inline bool is_hatched(Vec3d place, Vec3f normal, float period) {
  const Vec3f size{std::fabs(normal.x), std::fabs(normal.y), std::fabs(normal.z)};
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const double height = (place.x + place.y + place.z - place[axis]) / static_cast<double>(period);
  return height - std::floor(height) < static_cast<double>(kHatchWidth);
}

}  // namespace voxdag
