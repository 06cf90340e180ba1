#include "trace_cuda.hpp"

#include <optional>

#include "voxdag/cuda/timed_casts.hpp"

namespace voxdag {

TraceRunner cuda_runner(const DeviceScene& dag, RayClass rays, std::span<const CastRay> casts,
                        const RenderSetup* beams) {
  std::optional<TimedBeams> pass;
  if (beams != nullptr) pass.emplace(dag, *beams);
  TraceRunner runner;
  runner.name = "voxdag_cuda";
  runner.cast_set = [set = TimedCasts(dag, casts), pass, closest = is_closest(rays),
                     count = casts.size()](std::uint8_t* hits) {
    const double seconds = (pass ? pass->run() : 0.0) + (closest ? set.closest() : set.any());
    set.copy_hits({hits, count});
    return seconds;
  };
  return runner;
}

}  // namespace voxdag
