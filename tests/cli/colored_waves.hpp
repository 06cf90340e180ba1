#pragma once
/// A mesh with colours for tests of the command line.
#include <cmath>
#include <sstream>
#include <string>

namespace voxdag::cli {

/// Returns a wavy mesh whose vertices all have different colours. With materials, its triangles
/// have "left", "middle" and "right", from x = 0, 7 and 14 on.
inline std::string colored_waves(bool with_materials = false) {
  constexpr int kSide = 20;
  std::ostringstream text;
  for (int i = 0; i <= kSide; ++i)
    for (int j = 0; j <= kSide; ++j) {
      text << "v " << i << " " << 3 * std::sin(0.5 * i) * std::cos(0.4 * j) << " " << j;
      for (const int step : {37, 61, 89}) text << " " << (i * step + j * (step + 4)) % 101 / 100.0;
      text << "\n";
    }
  for (int i = 0; i < kSide; ++i) {
    const char* name = i == 0 ? "left" : i == 7 ? "middle" : i == 14 ? "right" : nullptr;
    if (with_materials && name != nullptr) text << "usemtl " << name << "\n";
    for (int j = 0; j < kSide; ++j) {
      const int first = 1 + i * (kSide + 1) + j, next = first + kSide + 1;
      text << "f " << first << " " << first + 1 << " " << next + 1 << " " << next << "\n";
    }
  }
  return text.str();
}

}  // namespace voxdag::cli
