#pragma once
/// Wraps casts on a CUDA device as a runner of `voxdag bench`.
#include <optional>

#include "lab/rays/trace_rays.hpp"
#include "lab/rays/trace_runner.hpp"
#include "voxdag/cuda/timed_casts.hpp"

namespace voxdag::lab {

/// Copies the set to the device and returns its runner. The runner measures device time, so copies
/// do not count. The time of `beams`, which computed the starts of the rays, counts. Throws Error
/// if there is not enough memory.
TraceRunner cuda_runner(const DeviceScene& scene, RayClass rays, std::span<const CastRay> casts,
                        const std::optional<TimedBeams>& beams);

}  // namespace voxdag::lab
