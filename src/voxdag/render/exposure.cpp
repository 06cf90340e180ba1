#include "voxdag/render/exposure.hpp"

#include <algorithm>
#include <cmath>

namespace voxdag {

float automatic_exposure(std::span<const Vec3f> radiance, std::span<const float> depth) {
  constexpr float kMiddle = 0.33f, kLeast = 0.42f, kMost = 0.9f;
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (!std::isfinite(depth[i])) continue;
    const float luminance = dot(radiance[i], {0.2126f, 0.7152f, 0.0722f});
    sum += std::log(static_cast<double>(luminance) + 1e-3);
    ++count;
  }
  if (count == 0) return kLeast;
  const double mean = std::exp(sum / static_cast<double>(count));
  return std::clamp(kMiddle / static_cast<float>(mean), kLeast, kMost);
}

}  // namespace voxdag
