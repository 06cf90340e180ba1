#pragma once
/// Finds the range of the colours of points, which files do not state.
#include <string>
#include <vector>

namespace voxdag {

/// Returns the value of a full component, from the greatest component of all points. Real numbers
/// go to 1, or to 255 if one is 2 or more. Numbers of 16 bits go to 65535; if none exceeds 255,
/// they go to 255, because many programs store 8 bits in 16, and a warning says so.
inline double color_range(bool are_real, double greatest, std::vector<std::string>& warnings) {
  if (are_real) return greatest >= 2 ? 255 : 1;
  if (greatest == 0 || greatest > 255) return 65535;
  warnings.emplace_back("16-bit colours are taken as 0 to 255: none is greater");
  return 255;
}

}  // namespace voxdag
