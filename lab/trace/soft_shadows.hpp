#pragma once
/// Measures soft shadows of lamps of several sizes, with and without beams towards the lamp
/// (Figure 7b of the SVDAG paper).
#include <cstdint>
#include <vector>

#include "lab/rays/trace_rays.hpp"
#include "voxdag/core/parallel/progress.hpp"

namespace voxdag::lab {

/// The shadow rays of all views towards a lamp.
struct SoftShadowRow {
  double light_size = 0;    ///< Radius of the lamp, in parts of its distance from the camera.
  std::uint64_t rays = 0;   ///< Rays without beams. With beams, fewer rays give the same picture.
  double beam_seconds = 0;  ///< For the shadows of all views, with the time of the beams.
  double no_beam_seconds = 0;  ///< Without beams.

  double mrays_with_beams() const { return static_cast<double>(rays) / beam_seconds * 1e-6; }
  double mrays_without_beams() const { return static_cast<double>(rays) / no_beam_seconds * 1e-6; }
};

/// Measures each of `light_sizes` in all views, with options.shadow_samples rays per pixel. Beams
/// on and off take turns; the fastest of `repeat` turns counts. Throws Cancelled.
std::vector<SoftShadowRow> measure_soft_shadows(const VoxelSet& scene, const Grid& grid,
                                                const std::vector<View>& views,
                                                const RayOptions& options,
                                                const std::vector<double>& light_sizes, int repeat,
                                                Progress& progress);

}  // namespace voxdag::lab
