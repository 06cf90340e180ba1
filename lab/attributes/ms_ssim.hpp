#pragma once
/// MS-SSIM: how alike two pictures look, from structure at five scales.
///
/// Zhou Wang, Eero Simoncelli and Alan Bovik: Multi-Scale Structural Similarity for Image Quality
/// Assessment, Asilomar 2003, with the constants of the authors' program.
#include <cstddef>
#include <vector>

namespace voxdag::lab {

/// A picture of one channel: rows from top to bottom, values from 0 to 255.
struct GreyImage {
  int width = 0, height = 0;
  std::vector<double> values;

  double at(int x, int y) const {
    return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
};

/// The smallest width and height that ms_ssim() takes: the window of 11 pixels at the fifth scale.
inline constexpr int kMinMsSsimSide = 11 * 16;

/// Returns the MS-SSIM of two pictures of one size, at least kMinMsSsimSide on each side: 1 if
/// they are equal, less otherwise. At each scale, a Gaussian window (11×11, sigma 1.5) measures the
/// means, variances and covariance wherever it fits into the picture. Contrast and structure count
/// at all scales, luminance at the coarsest one; a negative mean counts as 0. Between scales, the
/// pictures are halved: each pixel becomes the mean of 2×2. An odd last row or column is left out.
double ms_ssim(const GreyImage& a, const GreyImage& b);

}  // namespace voxdag::lab
