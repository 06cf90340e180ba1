#include "voxdag/render/exposure.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace voxdag {

float automatic_exposure(std::span<const Vec3f> radiance, std::span<const float> depth) {
  constexpr double kLeast = ExposureRule::kLeast;
  std::vector<float> luminances;
  for (std::size_t i = 0; i < depth.size(); ++i)
    if (std::isfinite(depth[i])) luminances.push_back(dot(radiance[i], ExposureRule::kLuminance));
  if (luminances.empty()) return ExposureRule::kOfNothing;
  double sum = 0;
  for (const float luminance : luminances)
    sum += std::log(std::max(static_cast<double>(luminance), kLeast));
  const double mean = std::exp(sum / static_cast<double>(luminances.size()));
  const auto bright =
      luminances.begin() +
      static_cast<std::ptrdiff_t>(ExposureRule::kBright * static_cast<double>(luminances.size()));
  std::nth_element(luminances.begin(), bright, luminances.end());
  const double white = std::max(static_cast<double>(*bright), kLeast);
  return static_cast<float>(std::min(ExposureRule::kMiddle / mean, ExposureRule::kWhite / white));
}

}  // namespace voxdag
