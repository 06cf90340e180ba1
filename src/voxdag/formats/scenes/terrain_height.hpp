#pragma once
/// Mountains as a grid of heights.
#include <cstdint>
#include <vector>

namespace voxdag::scenes {

/// (cells + 1)² heights in metres over a square of `side` metres.
struct HeightField {
  int cells = 0;
  double side = 0;
  std::vector<double> heights;

  double& at(int x, int z) { return heights[static_cast<std::size_t>(z) * (cells + 1) + x]; }
  double at(int x, int z) const { return heights[static_cast<std::size_t>(z) * (cells + 1) + x]; }
  double cell() const { return side / cells; }
  /// Returns the interpolated height; x and z are metres in [0, side].
  double height(double x, double z) const;
  /// Returns the slope in metres per metre.
  double slope(double x, double z) const;
};

/// Returns ridges from folded noise, eroded by raindrops that carry soil downhill.
HeightField mountain_heights(int cells, double side, std::uint32_t seed);

}  // namespace voxdag::scenes
