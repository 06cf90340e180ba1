#pragma once
/// How fast a CUDA device casts rays that lie in its memory: for benchmarks.
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
  /// Throws Error where memory is short.
  TimedCasts(const DeviceScene& dag, std::span<const CastRay> rays);

  /// Finds the first cell along each ray, or whether there is one. Returns the seconds from the
  /// start of the kernel to its end.
  double closest() const;
  double any() const;
  /// hits[i] becomes 1 where ray i met something in the last of these casts, else 0.
  void copy_hits(std::span<std::uint8_t> hits) const;

 private:
  struct State;
  std::shared_ptr<const State> state_;
};

/// The beams of a whole picture, on the DAG's device.
class TimedBeams {
 public:
  /// Of `setup` camera, grid and settings count.
  TimedBeams(const DeviceScene& dag, const RenderSetup& setup);

  /// Casts them; returns the device's seconds.
  double run() const;
  /// Casts them; returns what RenderSetup::beam_starts has.
  std::vector<float> starts() const;

 private:
  struct State;
  std::shared_ptr<const State> state_;
};

}  // namespace voxdag
