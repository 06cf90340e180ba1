#include "voxdag/cuda/timed_casts.hpp"

#include <cassert>

#include "voxdag/cuda/memory.hpp"
#include "voxdag/cuda/render_kernels.hpp"
#include "voxdag/cuda/stream.hpp"
#include "voxdag/cuda/trace_kernels.hpp"
#include "voxdag/render/tile.hpp"

namespace voxdag {

struct TimedCasts::State {
  DeviceScene dag;
  DeviceBuffer<CastRay> rays;
  DeviceBuffer<CellHit> cells;
  DeviceBuffer<std::uint8_t> hits;
};

TimedCasts::TimedCasts(const DeviceScene& dag, std::span<const CastRay> rays) {
  dag.make_current();
  require_device_memory(rays.size() * (sizeof(CastRay) + sizeof(CellHit) + 1), "the set of rays");
  state_ = std::make_shared<State>(State{dag, upload(rays, "rays"),
                                         make_device_buffer<CellHit>(rays.size(), "cells"),
                                         make_device_buffer<std::uint8_t>(rays.size(), "hits")});
}

double TimedCasts::closest() const {
  state_->dag.make_current();
  return seconds_of("casting rays", [&](cudaStream_t stream) {
    launch_closest_cells(state_->dag.view(), state_->rays.data(), state_->cells.data(),
                         state_->hits.data(), static_cast<std::uint32_t>(state_->rays.size()),
                         stream);
  });
}

double TimedCasts::any() const {
  state_->dag.make_current();
  return seconds_of("casting rays", [&](cudaStream_t stream) {
    launch_any_hits(state_->dag.view(), state_->rays.data(), state_->hits.data(),
                    static_cast<std::uint32_t>(state_->rays.size()), stream);
  });
}

void TimedCasts::copy_hits(std::span<std::uint8_t> hits) const {
  assert(hits.size() == state_->hits.size());
  copy_to_host(hits.data(), state_->hits.data(), hits.size());
}

struct TimedBeams::State {
  DeviceScene dag;
  RenderSetup setup;
  DeviceBuffer<float> starts;
};

TimedBeams::TimedBeams(const DeviceScene& dag, const RenderSetup& setup) {
  dag.make_current();
  const std::size_t beams = static_cast<std::size_t>(beams_across(setup.camera.width)) *
                            static_cast<std::size_t>(beams_across(setup.camera.height));
  state_ =
      std::make_shared<State>(State{dag, setup, make_device_buffer<float>(beams, "the beams")});
}

double TimedBeams::run() const {
  state_->dag.make_current();
  return seconds_of("casting beams", [&](cudaStream_t stream) {
    launch_beams(state_->dag.view(), state_->setup, 0,
                 static_cast<std::uint32_t>(state_->starts.size() / 4), state_->starts.data(),
                 stream);
  });
}

std::vector<float> TimedBeams::starts() const {
  run();
  std::vector<float> starts(state_->starts.size());
  copy_to_host(starts.data(), state_->starts.data(), starts.size() * sizeof(float));
  return starts;
}

}  // namespace voxdag
