#pragma once
/// The description of a picture for kernels: plain values and pointers.
#include <type_traits>

#include "voxdag/core/grid.hpp"
#include "voxdag/render/camera.hpp"
#include "voxdag/render/light.hpp"
#include "voxdag/render/sample_tables.hpp"
#include "voxdag/render/sky.hpp"
#include "voxdag/render/specular.hpp"
#include "voxdag/render/view_sample.hpp"
#include "voxdag/stored/attributes/look.hpp"
#include "voxdag/trace/ray_section.hpp"

namespace voxdag {

/// The diffuse colour of the surfaces at which a section cuts voxels.
inline constexpr Vec3f kCutAlbedo{0.45f, 0.06f, 0.03f};

/// The effects of a picture and their quality.
struct RenderSettings {
  int samples_per_pixel = 1;
  bool shadows = true;
  int light_samples = 1;            ///< Shadow rays per view sample and light with soft edges.
  int occlusion_samples = 0;        ///< Rays of ambient occlusion per view sample; 0: no occlusion.
  float occlusion_distance = 0.1f;  ///< Longest ray, in units of the grid's side.
  /// Occlusion rays end at cells of this side at distance 1; 0 means cells of the size of the
  /// surface's cell.
  float occlusion_cone = 0;
  /// Light reflected up to this many times arrives, by paths (path_light.hpp): occlusion_samples
  /// paths per view sample. -1: no paths, but ambient occlusion.
  int bounces = -1;
  /// Casts end at cells of at most this many pixels, so that voxels smaller than pixels do not
  /// cause noise; 0 means always at voxels.
  float lod_pixels = 1;
  /// Cells of at least this many pixels are shaded as cubes, cells of at most half as many as a
  /// smooth surface; 0 means always cubes.
  float cube_pixels = 24;
  float hatch_period = 0;  ///< Of the lines on cut faces, in grid sides; 0: none. See hatch.hpp.
  bool beams = true;       ///< Shorten rays by beams. The picture does not depend on it.
  Vec3f albedo{0.62f, 0.60f, 0.57f};
  Specular specular;
};

/// The buffers of a picture: width * height values each, rows from top to bottom. A null buffer is
/// not filled.
struct ImageBuffers {
  Vec3f* radiance = nullptr;  ///< Mean over the samples of surfaces, linear, before exposure.
  float* depth = nullptr;     ///< First sample's depth, world units; +infinity if it hit nothing.
  Vec3f* normal = nullptr;    ///< First sample's normal; zero if it hit nothing.
  float* occlusion =
      nullptr;              ///< Mean part of the sky's light that arrives; 1 where nothing was hit.
  float* shadow = nullptr;  ///< Mean part of the lights' light that arrives; 1 without light.
  float* steps = nullptr;   ///< Steps of the first sample's primary ray and its part of the beams.
  /// Size of the first sample's cell, see pack_cell_pixels(); 0 if the sample hit nothing.
  std::uint8_t* cell_pixels = nullptr;
  Vec3f* albedo = nullptr;    ///< First sample's diffuse colour, linear; zero if it hit nothing.
  SeenCell* cells = nullptr;  ///< First sample's cell.
  float* coverage = nullptr;  ///< Part of the samples that hit a surface.
};

/// A ground under the scene, see ground.hpp.
struct Ground {
  Vec3d middle{};
  double radius = 0;  ///< World units: shadows fade out up to here. 0: no ground.
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
  LookView look;       ///< See RenderOptions.
  RaySection section;  ///< All rays are limited to it.
  Ground ground;
  ImageBuffers image;
  /// The t at which the primary rays of 4×4 pixels may start: see primary_beams.hpp. Null without
  /// beams.
  const float* beam_starts = nullptr;

  VOXDAG_HD double side() const { return grid.side(); }
  /// Returns whether surfaces may have a metallic and a roughness number.
  VOXDAG_HD bool has_mirrors() const { return !look.dag.metallic_roughness.is_empty(); }
  VOXDAG_HD bool has_highlights() const { return settings.specular.is_on() || has_mirrors(); }
};

// Kernels take it by value; their parameters have room for 4 KB.
static_assert(std::is_trivially_copyable_v<RenderSetup> && sizeof(RenderSetup) <= 3584);

}  // namespace voxdag
