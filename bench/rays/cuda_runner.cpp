#include "bench/rays/cuda_runner.hpp"

#include <chrono>

namespace voxdag {
namespace {

using Clock = std::chrono::steady_clock;

/// Calls cast() repeatedly, at least once, and returns the seconds of the last call. An idle device
/// has a low clock, which rises only under load: a device that was idle for a tenth of a second
/// gets 0.3 seconds of casts.
template <class Cast>
double warm_seconds(const Cast& cast) {
  using std::chrono::milliseconds;
  static Clock::time_point last_end;
  const Clock::time_point start = Clock::now();
  const Clock::time_point warm =
      start + milliseconds(start - last_end > milliseconds(100) ? 300 : 20);
  double seconds = cast();
  while (Clock::now() < warm) seconds = cast();
  last_end = Clock::now();
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
