#pragma once
/// The pieces that pictures are made in.
#include "voxdag/core/host_device.hpp"

namespace voxdag {

/// A rectangle of pixels and where in each of them the sample lies.
struct ViewTile {
  int x = 0, y = 0;           ///< The top left pixel.
  int width = 0, height = 0;  ///< Pixels; the tile lies within the picture.
  int sample_index = 0;       ///< Which of a pixel's samples.
  double dx = 0.5, dy = 0.5;  ///< In [0,1): the sample of pixel (i,j) is at (i + dx, j + dy).
};

/// Pixels along the side of a beam, and of the beam that starts it off.
inline constexpr int kBeamPixels = 4, kCoarseBeamPixels = 8;

/// Beams in a row of a picture: a whole number of coarse ones.
VOXDAG_HD constexpr int beams_across(int pixels) {
  return (pixels + kCoarseBeamPixels - 1) / kCoarseBeamPixels * (kCoarseBeamPixels / kBeamPixels);
}

/// Which beam pixel (x,y) of a picture of this width is in.
VOXDAG_HD constexpr int beam_index(int width, int x, int y) {
  return y / kBeamPixels * beams_across(width) + x / kBeamPixels;
}

/// Where sample i of a pixel lies in it: the centre, then the R2 sequence around it (M. Roberts,
/// "The Unreasonable Effectiveness of Quasirandom Sequences", 2018).
VOXDAG_HD inline void set_sample(ViewTile& tile, int i) {
  const double x = 0.5 + i * 0.7548776662466927, y = 0.5 + i * 0.5698402909980532;
  tile.sample_index = i;
  tile.dx = x - static_cast<double>(static_cast<long long>(x));
  tile.dy = y - static_cast<double>(static_cast<long long>(y));
}

}  // namespace voxdag
