#pragma once
/// The launches of a picture's kernels.
#include <algorithm>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/cuda/launch_plan.hpp"
#include "voxdag/cuda/render_pixel.hpp"
#include "voxdag/cuda/stream.hpp"

namespace voxdag {

/// Block numbers have 32 bits, launches 31.
inline constexpr std::uint32_t kMaxBlocks = 1u << 30;

/// Returns the plan of the launches for all samples of `blocks` blocks of pixels.
inline LaunchPlan plan_launches(const RenderSetup& setup, std::uint32_t blocks,
                                std::uint32_t max_blocks, int max_samples) {
  constexpr double kFirstRays = 1 << 25;  // half a second on a slow device
  int rays = 1 + setup.settings.occlusion_samples;
  for (int i = 0; i < setup.light_count; ++i)
    rays += setup.lights[i].is_extended() ? setup.settings.light_samples : 1;
  if (setup.settings.bounces > 0)
    rays += setup.settings.occlusion_samples * setup.settings.bounces * (1 + setup.light_count);
  return {blocks,
          setup.settings.samples_per_pixel,
          static_cast<double>(rays) * kBlockPixels,
          kFirstRays,
          max_blocks,
          max_samples};
}

/// Calls launch(first, last) for all coarse beams of a picture, and waits after each call.
template <class Launch>
void for_beams(const Camera& camera, const CudaStream& stream, Work work, const Launch& launch) {
  constexpr std::uint32_t kBeamsPerLaunch = 1 << 18;
  const auto across = static_cast<std::uint32_t>(beams_across(camera.width) / 2);
  const auto down = static_cast<std::uint32_t>(beams_across(camera.height) / 2);
  const std::uint32_t count = across * down;
  for (std::uint32_t first = 0; first < count; first += kBeamsPerLaunch) {
    work.poll();
    launch(first, std::min(count, first + kBeamsPerLaunch));
    stream.wait("casting beams");
  }
}

}  // namespace voxdag
