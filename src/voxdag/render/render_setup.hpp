#pragma once
/// The description of a picture that kernels take: plain values and pointers.
#include <type_traits>

#include "voxdag/core/grid.hpp"
#include "voxdag/render/camera.hpp"
#include "voxdag/render/light.hpp"
#include "voxdag/render/sample_tables.hpp"
#include "voxdag/render/sky.hpp"

namespace voxdag {

/// What is computed, and how finely.
struct RenderSettings {
  int samples_per_pixel = 1;
  bool shadows = true;
  int light_samples = 1;            ///< Shadow rays per view sample and light with soft edges.
  int occlusion_samples = 0;        ///< Rays of ambient occlusion per view sample; 0: no occlusion.
  float occlusion_distance = 0.1f;  ///< Longest ray, in units of the grid's side.
  /// Rays of occlusion end at cells of this side at distance 1; 0: at cells of the surface's own
  /// size.
  float occlusion_cone = 0;
  /// Casts end at cells of at most this many pixels, so that voxels finer than pixels do not make
  /// noise; 0: always at voxels.
  float lod_pixels = 1;
  /// Cells look like cubes from this many pixels on, and like a smooth surface up to half as many;
  /// 0: always cubes.
  float cube_pixels = 24;
  bool beams = true;  ///< Shorten rays by beams. The picture does not depend on it.
  Vec3f albedo{0.62f, 0.60f, 0.57f};
};

/// The buffers of a picture: width * height values each, rows from top to bottom. Null if not
/// wanted.
struct ImageBuffers {
  Vec3f* radiance = nullptr;  ///< Mean over the samples, linear, before exposure.
  float* depth = nullptr;     ///< Of the first sample, world units; +infinity where it hit nothing.
  Vec3f* normal = nullptr;    ///< Of the first sample; zero where it hit nothing.
  float* occlusion =
      nullptr;              ///< Mean part of the sky's light that arrives; 1 where nothing was hit.
  float* shadow = nullptr;  ///< Mean part of the lights' light that arrives; 1 where there is none.
  float* steps = nullptr;  ///< Steps of the first sample's primary ray and its share of its beams'.
  /// Size of the first sample's cell, see pack_cell_pixels(); 0 where it hit nothing.
  std::uint8_t* cell_pixels = nullptr;
};

struct RenderSetup {
  static constexpr int kMaxLights = 16;

  Grid grid;
  Camera camera;
  Sky sky;
  RenderSettings settings;
  Light lights[kMaxLights];
  int light_count = 0;
  SampleTables tables;
  ImageBuffers image;
  /// Where the primary rays of 4×4 pixels may start: see primary_beams.hpp. Null without beams.
  const float* beam_starts = nullptr;

  VOXDAG_HD double side() const { return grid.side(); }
};

// Kernels take it by value; their parameters have room for 4 KB.
static_assert(std::is_trivially_copyable_v<RenderSetup> && sizeof(RenderSetup) <= 3584);

}  // namespace voxdag
