#include "bench/rays/cuda_runner.hpp"

#include <chrono>

namespace voxdag {
namespace {

/// Calls cast() repeatedly for 0.3 seconds, at least once, and returns the seconds of the last
/// call. An idle device has a low clock, which rises only under load.
template <class Cast>
double warm_seconds(const Cast& cast) {
  using Clock = std::chrono::steady_clock;
  const auto warm = Clock::now() + std::chrono::milliseconds(300);
  double seconds = cast();
  while (Clock::now() < warm) seconds = cast();
  return seconds;
}

}  // namespace

TraceRunner cuda_runner(const DeviceScene& scene, RayClass rays, std::span<const CastRay> casts,
                        const std::optional<TimedBeams>& beams) {
  TraceRunner runner;
  runner.name = "voxdag_cuda";
  runner.cast_set = [set = TimedCasts(scene, casts), beams, closest = is_closest(rays),
                     count = casts.size()](std::uint8_t* hits) {
    const double seconds = warm_seconds(
        [&] { return (beams ? beams->run() : 0.0) + (closest ? set.closest() : set.any()); });
    set.copy_hits({hits, count});
    return seconds;
  };
  return runner;
}

}  // namespace voxdag
