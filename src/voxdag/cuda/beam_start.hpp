#pragma once
/// The work of one thread of the beam kernel. Compiles for host and device: tests run it on the
/// host.
#include "voxdag/render/primary_beams.hpp"

namespace voxdag {

/// Sets the start of one beam of 4×4 pixels: part i % 4 of coarse beam i / 4. Coarse beams are
/// counted row by row. All four threads of a coarse beam cast it. If only one cast it, the other
/// three would have to wait.
template <class Nodes>
VOXDAG_HD inline void set_beam_start(const Nodes& nodes, const RenderSetup& setup, std::uint32_t i,
                                     float* picture) {
  const int width = setup.camera.width;
  const auto across =
      static_cast<std::uint32_t>((width + kCoarseBeamPixels - 1) / kCoarseBeamPixels);
  const int x = static_cast<int>(i / 4 % across) * kCoarseBeamPixels;
  const int y = static_cast<int>(i / 4 / across) * kCoarseBeamPixels;
  const int fine_x = x + static_cast<int>(i & 1u) * kBeamPixels;
  const int fine_y = y + static_cast<int>(i >> 1 & 1u) * kBeamPixels;
  double coarse = 0;
  float start = HUGE_VALF;
  if (cast_coarse_beam(nodes, setup, x, y, coarse))
    start = cast_fine_beam(nodes, setup, fine_x, fine_y, coarse);
  picture[beam_index(width, fine_x, fine_y)] = start;
}

}  // namespace voxdag
