#include "lab/attributes/ms_ssim.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace voxdag::lab {
namespace {

constexpr int kWindow = 11;
constexpr double kSigma = 1.5;
constexpr double kC1 = 0.01 * 255 * (0.01 * 255), kC2 = 0.03 * 255 * (0.03 * 255);
constexpr std::array<double, 5> kWeights{0.0448, 0.2856, 0.3001, 0.2363, 0.1333};

std::array<double, kWindow> gaussian() {
  std::array<double, kWindow> window{};
  double sum = 0;
  for (int i = 0; i < kWindow; ++i) {
    const double x = i - kWindow / 2;
    window[static_cast<std::size_t>(i)] = std::exp(-x * x / (2 * kSigma * kSigma));
    sum += window[static_cast<std::size_t>(i)];
  }
  for (double& weight : window) weight /= sum;
  return window;
}

/// Returns the weighted means of product(i), of pixel i, over the windows that fit into the
/// picture.
template <class Product>
GreyImage window_means(int width, int height, const Product& product) {
  static const std::array<double, kWindow> window = gaussian();
  const auto across = static_cast<std::size_t>(width - kWindow + 1),
             down = static_cast<std::size_t>(height - kWindow + 1);
  const auto columns = static_cast<std::size_t>(width);
  GreyImage means{width - kWindow + 1, height - kWindow + 1, std::vector<double>(across * down)};
  std::vector<double> line(columns), sums(across);
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
    for (std::size_t x = 0; x < columns; ++x) line[x] = product(y * columns + x);
    std::fill(sums.begin(), sums.end(), 0.0);
    for (std::size_t i = 0; i < kWindow; ++i)
      for (std::size_t x = 0; x < across; ++x) sums[x] += window[i] * line[x + i];
    // Row y is row i of the windows that begin at row y - i.
    for (std::size_t i = 0; i < kWindow; ++i) {
      if (y < i || y - i >= down) continue;
      double* const mean = means.values.data() + (y - i) * across;
      for (std::size_t x = 0; x < across; ++x) mean[x] += window[i] * sums[x];
    }
  }
  return means;
}

/// Means over all windows of one scale.
struct Similarity {
  double luminance = 0;           ///< Luminance, contrast and structure: the SSIM.
  double contrast_structure = 0;  ///< Contrast and structure.
};

Similarity compare(const GreyImage& a, const GreyImage& b) {
  const auto means = [&](const auto& product) { return window_means(a.width, a.height, product); };
  const double *const pa = a.values.data(), *const pb = b.values.data();
  const GreyImage mean_a = means([&](std::size_t i) { return pa[i]; });
  const GreyImage mean_b = means([&](std::size_t i) { return pb[i]; });
  const GreyImage squares_a = means([&](std::size_t i) { return pa[i] * pa[i]; });
  const GreyImage squares_b = means([&](std::size_t i) { return pb[i] * pb[i]; });
  const GreyImage products = means([&](std::size_t i) { return pa[i] * pb[i]; });
  Similarity sum;
  for (std::size_t i = 0; i < products.values.size(); ++i) {
    const double ma = mean_a.values[i], mb = mean_b.values[i];
    const double variances = squares_a.values[i] - ma * ma + squares_b.values[i] - mb * mb;
    const double covariance = products.values[i] - ma * mb;
    const double structure = (2 * covariance + kC2) / (variances + kC2);
    sum.contrast_structure += structure;
    sum.luminance += structure * (2 * ma * mb + kC1) / (ma * ma + mb * mb + kC1);
  }
  const auto count = static_cast<double>(products.values.size());
  return {sum.luminance / count, sum.contrast_structure / count};
}

GreyImage halved(const GreyImage& image) {
  GreyImage half{image.width / 2, image.height / 2, {}};
  for (int y = 0; y < half.height; ++y)
    for (int x = 0; x < half.width; ++x)
      half.values.push_back((image.at(2 * x, 2 * y) + image.at(2 * x + 1, 2 * y) +
                             image.at(2 * x, 2 * y + 1) + image.at(2 * x + 1, 2 * y + 1)) /
                            4);
  return half;
}

}  // namespace

double ms_ssim(const GreyImage& a, const GreyImage& b) {
  assert(a.width == b.width && a.height == b.height);
  assert(std::min(a.width, a.height) >= kMinMsSsimSide);
  GreyImage x = a, y = b;
  double product = 1;
  for (std::size_t scale = 0; scale < kWeights.size(); ++scale) {
    if (scale > 0) {
      x = halved(x);
      y = halved(y);
    }
    const Similarity similarity = compare(x, y);
    const double term =
        scale + 1 < kWeights.size() ? similarity.contrast_structure : similarity.luminance;
    product *= std::pow(std::max(term, 0.0), kWeights[scale]);
  }
  return product;
}

}  // namespace voxdag::lab
