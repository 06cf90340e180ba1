#include "voxdag/render/exposure.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace voxdag {

float automatic_exposure(std::span<const Vec3f> radiance, std::span<const float> depth) {
  constexpr double kMiddle = 0.3, kBright = 0.95, kWhite = 1.1;
  constexpr double kLeast = 1e-6;  // lower bound, so that black pixels do not dominate the mean
  std::vector<float> luminances;
  for (std::size_t i = 0; i < depth.size(); ++i)
    if (std::isfinite(depth[i]))
      luminances.push_back(dot(radiance[i], {0.2126f, 0.7152f, 0.0722f}));
  if (luminances.empty()) return 0.5f;
  double sum = 0;
  for (const float luminance : luminances)
    sum += std::log(std::max(static_cast<double>(luminance), kLeast));
  const double mean = std::exp(sum / static_cast<double>(luminances.size()));
  const auto bright = luminances.begin() +
                      static_cast<std::ptrdiff_t>(kBright * static_cast<double>(luminances.size()));
  std::nth_element(luminances.begin(), bright, luminances.end());
  const double white = std::max(static_cast<double>(*bright), kLeast);
  return static_cast<float>(std::min(kMiddle / mean, kWhite / white));
}

}  // namespace voxdag
