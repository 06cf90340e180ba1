#pragma once
/// What the stages of a tile hand to each other.
#include "voxdag/render/light_beam.hpp"
#include "voxdag/render/surface_point.hpp"
#include "voxdag/render/view_sample.hpp"

namespace voxdag {

/// For tiles of up to kPixels pixels: many for the wide casters of a CPU, one for a thread of a
/// GPU. Every array but `active` is indexed by the pixel in the tile, row by row.
template <int kPixels>
struct TileScratch {
  static constexpr int kMaxPixels = kPixels;

  ViewSample samples[kPixels];
  SurfacePoint points[kPixels];
  std::int32_t active[kPixels];  ///< Pixels that cast rays, in order.
  PixelSamples pixels[kPixels];  ///< For the light, or the occlusion, at hand.

  std::int32_t open[kPixels];  ///< Rays of occlusion that met nothing.

  LightInterval intervals[kPixels];  ///< Of the active pixels, for the light at hand.
  std::uint64_t visible[kPixels];    ///< Bit i: ray i of the batch at hand met nothing.
  float lit[kPixels];                ///< Sum of the weights of samples that arrive,
  float unhindered[kPixels];         ///< and of all.

  Vec3f irradiance[kPixels];                        ///< From all lights.
  float lit_sum[kPixels], unhindered_sum[kPixels];  ///< Luminance of it, and with nothing hidden.
};

}  // namespace voxdag
