#pragma once
/// The coarse pass before the primary rays: finds where the rays of 4×4 pixels may start.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 4.2. Here beams of
/// 8×8 pixels find the starts of beams of 4×4 pixels.
#include "voxdag/render/render_setup.hpp"
#include "voxdag/render/tile.hpp"
#include "voxdag/trace/beam.hpp"

namespace voxdag {

/// Returns the beam of the pixels [x, x + size) × [y, y + size).
VOXDAG_HD inline Beam pixel_beam(const RenderSetup& setup, int x, int y, int size) {
  const double to_unit = 1.0 / setup.side();
  Beam beam;
  beam.apex = (setup.camera.eye - setup.grid.origin) * to_unit;
  beam.lowest = beam.highest = setup.camera.direction(x, y) * to_unit;
  for (int corner = 1; corner < 4; ++corner) {
    const Vec3d direction =
        setup.camera.direction(x + (corner & 1) * size, y + (corner >> 1) * size) * to_unit;
    beam.lowest = min(beam.lowest, direction);
    beam.highest = max(beam.highest, direction);
  }
  return beam;
}

/// Returns the BeamStop of a beam: it ends at cells narrower than the beam, and at cells at which a
/// ray of the picture may end.
VOXDAG_HD inline BeamStop pixel_beam_stop(const RenderSetup& setup, int size) {
  constexpr double kRounding = 1 + 1e-6;  // for rounding in the rays' own float test
  const double pixel = setup.camera.pixel_size() / setup.side();
  BeamStop stop;
  stop.per_enter = size * pixel;
  stop.per_exit = static_cast<double>(setup.settings.lod_pixels) * pixel * kRounding;
  return stop;
}

/// Returns whether any ray through the 8×8 pixels at (x,y) meets anything. If so, sets `start` to a
/// t before which no ray does.
template <class Nodes>
VOXDAG_HD inline bool cast_coarse_beam(const Nodes& nodes, const RenderSetup& setup, int x, int y,
                                       double& start) {
  return first_met(nodes, pixel_beam(setup, x, y, kCoarseBeamPixels),
                   pixel_beam_stop(setup, kCoarseBeamPixels), start);
}

/// Returns a t before which no ray through the 4×4 pixels at (x,y) meets anything; +infinity if no
/// ray meets anything. `coarse` is the start of the 8×8 pixels that contain them.
template <class Nodes>
VOXDAG_HD inline float cast_fine_beam(const Nodes& nodes, const RenderSetup& setup, int x, int y,
                                      double coarse) {
  constexpr double kDown = 1 - 1e-6;  // rounds to float downwards
  Beam beam = pixel_beam(setup, x, y, kBeamPixels);
  beam.t_min = coarse;
  double start = 0;
  if (!first_met(nodes, beam, pixel_beam_stop(setup, kBeamPixels), start)) return HUGE_VALF;
  return static_cast<float>(start * kDown);
}

/// Sets starts[0..4) to the results of cast_fine_beam() for the 2×2 beams of the 8×8 pixels at
/// (x,y), row by row.
template <class Nodes>
VOXDAG_HD inline void cast_primary_beams(const Nodes& nodes, const RenderSetup& setup, int x, int y,
                                         float* starts) {
  double coarse = 0;
  const bool is_met = cast_coarse_beam(nodes, setup, x, y, coarse);
  for (int part = 0; part < 4; ++part) {
    const int fine_x = x + (part & 1) * kBeamPixels, fine_y = y + (part >> 1) * kBeamPixels;
    starts[part] = is_met ? cast_fine_beam(nodes, setup, fine_x, fine_y, coarse) : HUGE_VALF;
  }
}

/// Sets the starts of the 8×8 pixels at (x,y) in the array of a whole picture. The array has
/// beams_across(width) * beams_across(height) values; see beam_index().
template <class Nodes>
VOXDAG_HD inline void set_beam_starts(const Nodes& nodes, const RenderSetup& setup, int x, int y,
                                      float* picture) {
  float starts[4];
  cast_primary_beams(nodes, setup, x, y, starts);
  for (int part = 0; part < 4; ++part)
    picture[beam_index(setup.camera.width, x + (part & 1) * kBeamPixels,
                       y + (part >> 1) * kBeamPixels)] = starts[part];
}

}  // namespace voxdag
