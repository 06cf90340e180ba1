#pragma once
/// Casts on a CUDA device for `voxdag bench trace`.
#include "trace_rivals.hpp"
#include "voxdag/cuda/device_scene.hpp"

namespace voxdag {

/// Copies the set to the device. The seconds are the device's own: copies do not count. With
/// `beams` the beams of that picture count, too. Throws Error where memory is short.
TraceRunner cuda_runner(const DeviceScene& dag, RayClass rays, std::span<const CastRay> casts,
                        const RenderSetup* beams);

}  // namespace voxdag
