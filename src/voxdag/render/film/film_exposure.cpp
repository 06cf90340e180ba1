#include "voxdag/render/film/film_exposure.hpp"

#include <algorithm>
#include <cmath>

namespace voxdag {

RenderOptions thumbnail_options(const RenderOptions& options) {
  RenderOptions small = options;
  small.width = 64;
  small.height = 36;
  small.samples_per_pixel = 1;
  small.shadow_samples = std::min(options.shadow_samples, 4);
  small.occlusion_samples = std::min(options.occlusion_samples, 8);
  return small;
}

std::vector<float> film_exposures(const CameraPath& path, std::span<const double> times,
                                  const RenderOptions& options, const PictureRenderer& render,
                                  WorkQueue& queue, Work work) {
  if (options.exposure > 0) return std::vector<float>(times.size(), options.exposure);
  RenderOptions small = thumbnail_options(options);
  const auto logs = results_of<double>(queue, times.size(), [&](std::size_t i) {
    small.view = as_request(path.at(times[i]), small.view);
    const double log = std::log(static_cast<double>(render(small, {}).exposure));
    work.poll();
    work.report_done("exposure", i + 1, times.size());
    return log;
  });
  return smoothed_exposures(times, logs);
}

std::vector<float> smoothed_exposures(std::span<const double> times, std::span<const double> logs) {
  constexpr double kSpread = 0.5;          // standard deviation, seconds
  constexpr double kReach = 10 * kSpread;  // farther weights vanish in rounding
  std::vector<float> smooth;
  smooth.reserve(times.size());
  std::size_t first = 0;
  for (const double time : times) {
    while (times[first] < time - kReach) ++first;
    double sum = 0, weight = 0;
    for (std::size_t i = first; i < times.size() && times[i] <= time + kReach; ++i) {
      const double d = (times[i] - time) / kSpread;
      const double w = std::exp(-0.5 * d * d);
      sum += w * logs[i];
      weight += w;
    }
    smooth.push_back(static_cast<float>(std::exp(sum / weight)));
  }
  return smooth;
}

}  // namespace voxdag
