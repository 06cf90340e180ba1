#pragma once
/// One sample of a picture: primary ray, normal, sun with hard shadow, sky.
#include <cmath>
#include <limits>

#include "voxdag/render/camera.hpp"
#include "voxdag/render/sky.hpp"
#include "voxdag/render/surface_normal.hpp"
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/stop_below_size.hpp"

namespace voxdag {

/// What the surfaces and the traversal of a picture are like.
struct ShadeOptions {
  bool shadows = true;
  /// Casts end at cells of at most this many pixels, so that voxels finer than pixels do not make
  /// noise; 0: always at voxels.
  float lod_pixels = 1;
  /// Cells look like cubes from this many pixels on, and like a smooth surface up to half as many;
  /// 0: always cubes.
  float cube_pixels = 24;
  Vec3f albedo{0.62f, 0.60f, 0.57f};
  float exposure = 0;  ///< Factor before tone mapping; 0: what suits the picture.
};

struct Sample {
  Vec3f radiance;  ///< Scene light, before exposure and tone mapping.
  float depth = std::numeric_limits<float>::infinity();  ///< Along the camera's axis.
  Vec3f normal{};                                        ///< Zero where nothing was met.
  int rays = 1;
};

/// Whether something stands between a surface cell and the sun. The ray starts two cells above the
/// surface and one before the face where the cell was met: every cell of a plane with this normal
/// lies within sqrt(3) cells of the point where a ray met it, so that a smooth surface does not
/// shadow itself. It ends at cells of the surface cell's own size, so that picture and shadow agree
/// on what is there.
template <class Nodes>
VOXDAG_HD inline bool is_in_shadow(const Nodes& nodes, const Grid& grid, Vec3d point, Vec3f normal,
                                   Vec3f face, int level, Vec3f sun) {
  const double cell_size =
      grid.voxel_size * static_cast<double>(std::int64_t{1} << (grid.levels - level));
  const Vec3d origin = point + static_cast<Vec3d>(normal * 2.0f + face) * cell_size;
  const GridRay ray = make_grid_ray(grid, origin, static_cast<Vec3d>(sun), 0, HUGE_VAL);
  const StopBelowSize stop{std::ldexp(1.0f, -level), 0, 2};
  CellHit cell;
  return cast(nodes, ray, stop, cell);
}

/// The sample at (x,y) of the picture, in pixels from its top left corner.
template <class Nodes>
VOXDAG_HD inline Sample shade_sample(const Nodes& nodes, const Grid& grid, const Camera& camera,
                                     const Sky& sky, const ShadeOptions& options, double x,
                                     double y) {
  Sample sample;
  const Vec3d direction = camera.direction(x, y);
  const GridRay ray = make_grid_ray(grid, camera.eye, direction, 0, HUGE_VAL);
  const double pixel_size = camera.pixel_size();
  CellHit cell;
  const bool is_hit =
      cast(nodes, ray, stop_below_size(grid, ray, options.lod_pixels * pixel_size), cell);
  const Vec3f unit_direction = static_cast<Vec3f>(normalized(direction));
  if (!is_hit) {
    sample.radiance = sky_radiance(sky, unit_direction);
    return sample;
  }
  const Hit hit = to_hit(ray, cell, grid.levels, 0, HUGE_VALF);
  const double depth = ray.to_world_t(static_cast<double>(cell.t));
  sample.depth = static_cast<float>(depth);

  const Vec3f view = -unit_direction;
  const int shift = grid.levels - hit.level;
  const Vec3f face = hit.face == Face::kNone ? view : static_cast<Vec3f>(face_normal(hit.face));
  Vec3f smooth = face;
  sample.normal = face;
  const float cell_pixels = static_cast<float>(
      grid.voxel_size * static_cast<double>(std::int64_t{1} << shift) / (pixel_size * depth));
  const float cube = smooth_step(options.cube_pixels / 2, options.cube_pixels, cell_pixels);
  if (cube < 1 && hit.level >= 2) {
    const Vec3i at{hit.voxel.x >> shift, hit.voxel.y >> shift, hit.voxel.z >> shift};
    smooth = surface_normal(nodes, hit.level, at, view, face);
    sample.normal = normalized(mix(smooth, face, cube));
  }

  // No occlusion is computed, so that the sky's light alone would leave shadows flat: light from
  // the viewer and, softly, from the viewer's right keeps apart what sun and sky do not.
  const float facing = dot(sample.normal, view);
  const float aside = dot(sample.normal, sky.fill);
  const Vec3f light_from_sky = sky_ambient(sky, sample.normal);
  Vec3f light = light_from_sky * (0.40f + 0.35f * facing + 0.25f * aside);
  const float towards_sun = dot(sample.normal, sky.sun);
  if (towards_sun > 0) {
    bool is_lit = true;
    if (options.shadows) {
      const Vec3d point = camera.eye + direction * depth;
      is_lit = !is_in_shadow(nodes, grid, point, smooth, face, hit.level, sky.sun);
      ++sample.rays;
    }
    if (is_lit) light = light + sky.sun_irradiance * towards_sun;
  }
  sample.radiance = light * options.albedo;
  return sample;
}

}  // namespace voxdag
