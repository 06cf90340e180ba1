#pragma once
/// The arrays that the stages of a tile share.
#include <type_traits>

#include "voxdag/render/light_beam.hpp"
#include "voxdag/render/surface_normal.hpp"
#include "voxdag/render/surface_point.hpp"
#include "voxdag/render/view_sample.hpp"

namespace voxdag {

/// No arrays for paths.
struct NoPathScratch {};

/// Arrays for tiles of up to kPixels pixels: many for packets on the CPU, one for a GPU thread.
/// Every array but `active` is indexed by the tile's pixel, in the order of ViewTile. `Paths` is
/// PathScratch<kPixels> if the light may bounce. `Layers` finds the layers of smooth surfaces.
template <int kPixels, class Paths = NoPathScratch, class Layers = FreshLayers>
struct TileScratch {
  static constexpr bool kWithPaths = !std::is_same_v<Paths, NoPathScratch>;

  ViewSample samples[kPixels];
  SurfacePoint points[kPixels];
  std::int32_t active[kPixels];  ///< Pixels that cast rays, in order.
  PixelSamples pixels[kPixels];  ///< For the current light, or for occlusion.

  std::int32_t open[kPixels];  ///< Occlusion rays that met nothing.

  LightInterval intervals[kPixels];  ///< Per active pixel, for the current light.
  std::uint64_t visible[kPixels];    ///< Bit i: ray i of the current batch met nothing.
  float lit[kPixels];                ///< Weights of the light's unoccluded samples, summed.
  float unhindered[kPixels];         ///< Weights of all its samples, summed.

  Vec3f irradiance[kPixels];  ///< Irradiance from all lights.
  Vec3f highlights[kPixels];  ///< Radiance of the highlights of all lights, if surfaces have any.
  float lit_sum[kPixels],
      unhindered_sum[kPixels];  ///< Luminance from all lights, and without occluders.

  Paths paths;

  Layers layers;
};

}  // namespace voxdag
