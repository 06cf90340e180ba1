#pragma once
/// Tiles: the rectangles in which pictures are rendered.
#include "voxdag/core/host_device.hpp"

namespace voxdag {

/// A rectangle of pixels, and the position of the sample in each of them.
struct ViewTile {
  int x = 0, y = 0;           ///< The top left pixel.
  int width = 0, height = 0;  ///< Pixels; the tile lies within the picture.
  int sample_index = 0;       ///< Index of the sample in its pixel.
  double dx = 0.5, dy = 0.5;  ///< In [0,1): the sample of pixel (i,j) is at (i + dx, j + dy).

  /// Returns the number of pixels. Pixels are numbered down the columns of strips of 8 rows, so
  /// that 8 or 64 consecutive pixels are close together: their rays are cast together.
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

/// The sides in pixels of a beam, and of the coarse beam that finds its start.
inline constexpr int kBeamPixels = 4, kCoarseBeamPixels = 8;

/// Returns the number of beams in a row of a picture, rounded up to whole coarse beams.
VOXDAG_HD constexpr int beams_across(int pixels) {
  return (pixels + kCoarseBeamPixels - 1) / kCoarseBeamPixels * (kCoarseBeamPixels / kBeamPixels);
}

/// Returns the index of the beam of pixel (x,y) in a picture of this width.
VOXDAG_HD constexpr int beam_index(int width, int x, int y) {
  return y / kBeamPixels * beams_across(width) + x / kBeamPixels;
}

/// Sets the position of sample i in its pixel: the centre, then the R2 sequence around it (M.
/// Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018).
VOXDAG_HD inline void set_sample(ViewTile& tile, int i) {
  const double x = 0.5 + i * 0.7548776662466927, y = 0.5 + i * 0.5698402909980532;
  tile.sample_index = i;
  tile.dx = x - static_cast<double>(static_cast<long long>(x));
  tile.dy = y - static_cast<double>(static_cast<long long>(y));
}

}  // namespace voxdag
