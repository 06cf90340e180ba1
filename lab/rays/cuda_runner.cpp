#include "lab/rays/cuda_runner.hpp"

#include "lab/rays/warm_seconds.hpp"

namespace voxdag::lab {

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

}  // namespace voxdag::lab
