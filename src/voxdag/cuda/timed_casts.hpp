#pragma once
/// Times casts of rays in the memory of a CUDA device, for benchmarks.
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "voxdag/cuda/device_scene.hpp"
#include "voxdag/render/render_setup.hpp"
#include "voxdag/trace/scalar_caster.hpp"

namespace voxdag {

/// A set of rays in the memory of a DAG's device.
class TimedCasts {
 public:
  /// Copies the rays to the DAG's device. Throws Error if there is not enough memory.
  TimedCasts(const DeviceScene& dag, std::span<const CastRay> rays);

  /// Finds the first cell along each ray (closest) or whether there is one (any). Returns the time
  /// of the kernel in seconds.
  double closest() const;
  double any() const;
  /// Sets hits[i] to 1 if ray i met something in the last of these casts, else to 0.
  void copy_hits(std::span<std::uint8_t> hits) const;

 private:
  struct State;
  std::shared_ptr<const State> state_;
};

/// Times the beams of a whole picture on the DAG's device.
class TimedBeams {
 public:
  /// Uses the camera, grid and settings of `setup`.
  TimedBeams(const DeviceScene& dag, const RenderSetup& setup);

  /// Casts the beams and returns the device time in seconds.
  double run() const;
  /// Casts the beams and returns their starts, as in RenderSetup::beam_starts.
  std::vector<float> starts() const;

 private:
  struct State;
  std::shared_ptr<const State> state_;
};

}  // namespace voxdag
