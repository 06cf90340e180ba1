#pragma once
/// A square of mountains as heights on a grid.
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
  /// Between grid points, x and z in metres within [0, side].
  double height(double x, double z) const;
  /// Metres of rise per metre.
  double slope(double x, double z) const;
};

/// Ridges from folded noise, then carved by drops of rain that carry soil downhill.
HeightField mountain_heights(int cells, double side, std::uint32_t seed);

}  // namespace voxdag::scenes
