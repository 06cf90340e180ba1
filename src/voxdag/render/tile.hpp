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

  /// Pixels are numbered down the columns of strips of 8 rows, so that any 8, 64 or so that follow
  /// one another lie close together: their rays are cast together.
  VOXDAG_HD constexpr int pixels() const { return width * height; }
  VOXDAG_HD constexpr int column(int pixel) const {
    return pixel % (kStripRows * width) / strip_height(pixel);
  }
  VOXDAG_HD constexpr int row(int pixel) const {
    return strip(pixel) * kStripRows + pixel % (kStripRows * width) % strip_height(pixel);
  }

 private:
  static constexpr int kStripRows = 8;
  VOXDAG_HD constexpr int strip(int pixel) const { return pixel / (kStripRows * width); }
  VOXDAG_HD constexpr int strip_height(int pixel) const {
    const int left = height - strip(pixel) * kStripRows;
    return left < kStripRows ? left : kStripRows;
  }
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
