#pragma once
/// Counts the steps of primary rays: the measure of Laine and Karras, "Efficient Sparse Voxel
/// Octrees", I3D 2010, Figure 9.
#include <cstdint>

#include "voxdag/core/host_device.hpp"
#include "voxdag/render/primary_beams.hpp"
#include "voxdag/render/voxel_view_samples.hpp"

namespace voxdag {

/// A node layout that behaves like `Nodes` and counts the steps of walks.
template <class Nodes>
class CountingNodes : public Nodes {
 public:
  VOXDAG_HD CountingNodes(const Nodes& nodes, std::uint32_t& steps)
      : Nodes(nodes), steps_(&steps) {}

  VOXDAG_HD void on_step() const { ++*steps_; }

 private:
  std::uint32_t* steps_;
};

/// Sets setup.image.steps of the 8×8 pixels at (x,y) to the steps of their first samples' rays. If
/// setup.beam_starts is set, each pixel also gets an equal part of its beams' steps.
template <class Nodes>
VOXDAG_HD inline void count_steps(const Nodes& nodes, const RenderSetup& setup, int x, int y) {
  constexpr int kSide = kCoarseBeamPixels, kBeams = kSide / kBeamPixels;
  const Camera& camera = setup.camera;
  std::uint32_t beam_steps = 0;
  if (setup.beam_starts != nullptr) {
    const CountingNodes<Nodes> counting(nodes, beam_steps);
    float starts[kBeams * kBeams];
    cast_primary_beams(counting, setup, x, y, starts);
  }
  for (int row = y; row < y + kSide && row < camera.height; ++row)
    for (int column = x; column < x + kSide && column < camera.width; ++column) {
      std::uint32_t steps = 0;
      const CountingNodes<Nodes> counting(nodes, steps);
      const CastRay ray = primary_ray(setup, {column, row, 1, 1}, 0);
      CellHit cell;
      cast(counting, ray.ray, ray.stop, cell);
      const std::size_t at =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(camera.width) +
          static_cast<std::size_t>(column);
      setup.image.steps[at] =
          static_cast<float>(steps) + static_cast<float>(beam_steps) / (kSide * kSide);
    }
}

}  // namespace voxdag
