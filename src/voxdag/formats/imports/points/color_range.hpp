#pragma once
/// The range of colours that no file states.
#include <string>
#include <vector>

namespace voxdag {

/// Returns what stands for a full component, from the greatest component of a file. Real numbers go
/// to 1, or to 255 if one is 2 or more. Numbers of 16 bits go to 65535, but many programs store 8:
/// if none exceeds 255, they go to 255; this warns of that.
inline double color_range(bool are_real, double greatest, std::vector<std::string>& warnings) {
  if (are_real) return greatest >= 2 ? 255 : 1;
  if (greatest == 0 || greatest > 255) return 65535;
  warnings.emplace_back("its colours of 16 bits are taken as 0 to 255: none is greater");
  return 255;
}

}  // namespace voxdag
