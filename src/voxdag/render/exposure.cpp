#include "voxdag/render/exposure.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "voxdag/core/parallel/parallel_for.hpp"

namespace voxdag {
namespace {

constexpr double kMin = ExposureRule::kMin;

/// The surfaces in a run of pixels. Sums over runs of a fixed length do not depend on the number of
/// threads.
struct PixelRun {
  std::vector<float> luminances;
  double sum_of_logs = 0;
};

PixelRun measure(std::span<const Vec3f> radiance, std::span<const float> depth) {
  PixelRun run;
  run.luminances.reserve(depth.size());
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (!std::isfinite(depth[i])) continue;
    const float luminance = dot(radiance[i], ExposureRule::kLuminance);
    run.luminances.push_back(luminance);
    run.sum_of_logs += std::log(std::max(static_cast<double>(luminance), kMin));
  }
  return run;
}

}  // namespace

float automatic_exposure(std::span<const Vec3f> radiance, std::span<const float> depth) {
  constexpr std::size_t kRun = 1 << 16;  // pixels
  std::vector<PixelRun> runs((depth.size() + kRun - 1) / kRun);
  parallel_for(runs.size(), [&](std::size_t i) {
    const std::size_t length = std::min(kRun, depth.size() - i * kRun);
    runs[i] = measure(radiance.subspan(i * kRun, length), depth.subspan(i * kRun, length));
  });
  std::vector<float> luminances;
  luminances.reserve(depth.size());
  double sum = 0;
  for (const PixelRun& run : runs) {
    luminances.insert(luminances.end(), run.luminances.begin(), run.luminances.end());
    sum += run.sum_of_logs;
  }
  if (luminances.empty()) return ExposureRule::kOfNothing;
  const double mean = std::exp(sum / static_cast<double>(luminances.size()));
  const auto bright =
      luminances.begin() +
      static_cast<std::ptrdiff_t>(ExposureRule::kBright * static_cast<double>(luminances.size()));
  std::nth_element(luminances.begin(), bright, luminances.end());
  const double white = std::max(static_cast<double>(*bright), kMin);
  return static_cast<float>(
      std::min({ExposureRule::kMiddle / mean, ExposureRule::kWhite / white, ExposureRule::kMost}));
}

}  // namespace voxdag
