#pragma once
/// Ambient occlusion: the fraction of the sky's light that reaches a point past its surroundings.
///
/// Source: S. Laine and T. Karras, "Two Methods for Fast Ray-Cast Ambient Occlusion", EGSR 2010, as
/// used by Kämpe, Sintorn and Assarsson, "High Resolution Sparse Voxel DAGs", SIGGRAPH 2013,
/// section 4.
///
/// The occlusion by a surface at distance d has the weight (1 - d/longest)². Instead of the closest
/// hits of rays of equal length, the method tests whether rays of random length hit anything; the
/// lengths are distributed so that the mean is equal. Rays may end at cells that subtend a given
/// solid angle: the result is darker, but exact near contacts.
#include "voxdag/render/basis.hpp"
#include "voxdag/render/ground.hpp"
#include "voxdag/render/tile.hpp"
#include "voxdag/render/tile_scratch.hpp"
#include "voxdag/trace/scalar_caster.hpp"

namespace voxdag {

/// Returns a direction of the hemisphere around (0,0,1), turned to the point's shading normal. If
/// it lies below the plane of the surface itself, whose normal may differ, it is mirrored there.
VOXDAG_HD inline Vec3f around_normal(const SurfacePoint& point, Vec3f local) {
  const Basis<float> basis = make_basis(point.normal);
  const Vec3f direction = basis.u * local.x + basis.v * local.y + point.normal * local.z;
  const float above = dot(direction, point.face);
  return above < 0 ? direction - point.face * (2 * above) : direction;
}

/// Returns ray `i` of a point, around its normal.
/// `longest` is in units of the grid's side; `cone` as in RenderSettings::occlusion_cone.
/// `make_ray(direction, t_max)` makes the ray.
template <class MakeRay>
VOXDAG_HD inline CastRay occlusion_ray(const SampleTables& tables, float longest, float cone,
                                       const SurfacePoint& point, const PixelSamples& pixel, int i,
                                       const MakeRay& make_ray) {
  const HemisphereSample sample = tables.hemisphere[pixel.set * tables.hemisphere_count + i];
  const Point2f flat = pixel.rotated({sample.direction.x, sample.direction.y});
  const Vec3f direction = around_normal(point, {flat.x, flat.y, sample.direction.z});
  CastRay ray;
  ray.ray = make_ray(direction, sample.reach * longest);
  ray.stop.at_start = point.cell_side;
  ray.stop.per_t = cone * static_cast<float>(ray.ray.t_scale);
  return ray;
}
VOXDAG_HD inline CastRay occlusion_ray(const SampleTables& tables, float longest, float cone,
                                       const SurfacePoint& point, const PixelSamples& pixel,
                                       int i) {
  return occlusion_ray(tables, longest, cone, point, pixel, i, [&](Vec3f direction, float t_max) {
    return make_grid_ray(point.start, direction, 0, t_max);
  });
}

/// Sets scratch.open for the pixels that show something. Returns the number of rays.
template <class Caster, class Scratch>
VOXDAG_HD inline int trace_occlusion(const Caster& caster, const RenderSetup& setup,
                                     const ViewTile& tile, Scratch& scratch) {
  const RenderSettings& settings = setup.settings;
  const int rays = settings.occlusion_samples;
  const int first = tile.sample_index * rays;
  int active = 0;
  for (int pixel = 0; pixel < tile.width * tile.height; ++pixel) {
    if (!scratch.points[pixel].is_hit()) continue;
    scratch.active[active++] = pixel;
    scratch.open[pixel] = 0;
    scratch.pixels[pixel] =
        pixel_samples(setup.tables, tile.x + tile.column(pixel), tile.y + tile.row(pixel), 0);
  }
  caster.any(
      active * rays,
      [&](int i) {
        const int pixel = scratch.active[i / rays];
        CastRay ray =
            occlusion_ray(setup.tables, settings.occlusion_distance, settings.occlusion_cone,
                          scratch.points[pixel], scratch.pixels[pixel], first + i % rays,
                          [&](Vec3f direction, float t_max) {
                            return ray_from(setup, scratch.samples[pixel], scratch.points[pixel],
                                            direction, 0, t_max);
                          });
        limit_to(setup.section, ray.ray);
        return ray;
      },
      [&](int i, bool is_hit) { scratch.open[scratch.active[i / rays]] += is_hit ? 0 : 1; });
  return active * rays;
}

}  // namespace voxdag
