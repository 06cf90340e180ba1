#pragma once
/// Casts on a CUDA device for `voxdag bench trace`.
#include <optional>

#include "bench/rays/trace_rays.hpp"
#include "bench/rays/trace_runner.hpp"
#include "voxdag/cuda/timed_casts.hpp"

namespace voxdag {

/// Copies the set to the device. The seconds are the device's own: copies do not count. The beams
/// that gave the set its starts, if any, do. Throws Error where memory is short.
TraceRunner cuda_runner(const DeviceScene& dag, RayClass rays, std::span<const CastRay> casts,
                        const std::optional<TimedBeams>& beams);

}  // namespace voxdag
