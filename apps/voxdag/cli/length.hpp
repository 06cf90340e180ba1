#pragma once
/// Lengths of the command line.
#include <string>

namespace voxdag::cli {

struct Length {
  double value = 0;
  std::string unit;  ///< mm, cm, m, in or ft; empty: the unit of the coordinates.
};

/// Parses a finite length above zero: "2mm", "0.1in", or "2" in the unit of the coordinates. Throws
/// std::invalid_argument with the reason.
Length parse_length(const std::string& text);

/// Returns the length in `scene_unit`, the unit of a scene's coordinates. Throws Error, which names
/// `path`, if the length has a unit and that of the scene is not known (empty).
double in_scene_unit(const Length& length, const std::string& scene_unit, const std::string& path);

}  // namespace voxdag::cli
