#pragma once
/// The primary rays of a tile, and the view samples of rays at the voxels of a DAG.
#include "voxdag/render/hatch.hpp"
#include "voxdag/render/render_setup.hpp"
#include "voxdag/render/stored_look.hpp"
#include "voxdag/render/surface_normal.hpp"
#include "voxdag/render/tile.hpp"
#include "voxdag/render/tile_scratch.hpp"
#include "voxdag/trace/esvo_nodes.hpp"
#include "voxdag/trace/scalar_caster.hpp"

namespace voxdag {

/// Returns the direction of the camera's ray through a pixel of the tile. The ray's t is its depth.
VOXDAG_HD inline Vec3d pixel_direction(const RenderSetup& setup, const ViewTile& tile, int pixel) {
  return setup.camera.direction(tile.x + tile.column(pixel) + tile.dx,
                                tile.y + tile.row(pixel) + tile.dy);
}

/// Returns the primary ray of a pixel of the tile.
VOXDAG_HD inline CastRay primary_ray(const RenderSetup& setup, const ViewTile& tile, int pixel) {
  const int x = tile.x + tile.column(pixel), y = tile.y + tile.row(pixel);
  double t_min = 0;
  if (setup.beam_starts != nullptr) {
    t_min = static_cast<double>(setup.beam_starts[beam_index(setup.camera.width, x, y)]);
    if (!(t_min < HUGE_VAL)) return {};
  }
  CastRay ray;
  ray.ray = make_grid_ray(setup.grid, setup.camera.eye, pixel_direction(setup, tile, pixel), t_min,
                          HUGE_VAL);
  limit_to(setup.section, ray.ray);
  const double size_per_t =
      static_cast<double>(setup.settings.lod_pixels) * setup.camera.pixel_size();
  ray.stop = stop_below_size(setup.grid, ray.ray, size_per_t);
  return ray;
}

/// Returns the camera's line through a pixel of the tile.
VOXDAG_HD inline SightLine pixel_line(const RenderSetup& setup, const ViewTile& tile, int pixel) {
  return {setup.camera.eye, pixel_direction(setup, tile, pixel)};
}

/// Returns the view sample at which a ray along `line` hit a cell, at `t`. `depth` is the distance
/// from the camera that decides how smooth the cell looks. `layers`: see smooth_surface().
template <class Nodes, class Layers>
VOXDAG_HD inline ViewSample voxel_view_sample(const Nodes& nodes, const RenderSetup& setup,
                                              const SightLine& line, const Hit& hit, double t,
                                              double depth, Layers& layers) {
  const RenderSettings& settings = setup.settings;
  const int shift = setup.grid.levels - hit.level;
  const double cell_size = setup.grid.cell_size(hit.level);
  const Vec3f view = -static_cast<Vec3f>(normalized(line.direction));
  const Vec3f face = hit.face == Face::kNone ? view : static_cast<Vec3f>(face_normal(hit.face));
  const float cell_pixels = static_cast<float>(cell_size / (setup.camera.pixel_size() * depth));
  const float cube = smooth_step(settings.cube_pixels / 2, settings.cube_pixels, cell_pixels);
  ViewSample sample;
  SmoothSurface smooth;
  sample.normal = face;
  const Vec3i at{hit.voxel.x >> shift, hit.voxel.y >> shift, hit.voxel.z >> shift};
  if (cube < 1 && hit.level >= 2) {
    smooth = smooth_surface(nodes, hit.level, at, view, face, layers);
    sample.normal = normalized(mix(smooth.normal, face, cube));
  }
  sample.face = sample.normal;
  sample.albedo = settings.albedo;
  set_stored_look(setup.look, at, hit.level, view, face, sample);
  sample.depth = static_cast<float>(t);
  sample.cell_size = static_cast<float>(cell_size);
  const Vec3d entered = line.origin + line.direction * t;
  // The surface's plane meets the cell, so the entered face lies at most this far below the plane.
  const float below = cube_height(sample.face) - dot(sample.face, face);
  double lift = below > 0 ? static_cast<double>(below) : 0.0;
  // Points on the smooth surface itself have shadows without the steps of the cells.
  const auto trust = static_cast<double>(smooth.is_flat * (1 - cube));
  if (trust > 0) {
    const Vec3d centre =
        setup.grid.origin + (static_cast<Vec3d>(at) + Vec3d{0.5, 0.5, 0.5}) * cell_size;
    const double above =
        dot((entered - centre) * (1 / cell_size), static_cast<Vec3d>(sample.face)) -
        static_cast<double>(smooth.height);
    lift = lift * (1 - trust) - above * trust;
  }
  sample.point = entered + static_cast<Vec3d>(sample.face) * (lift * cell_size);
  return sample;
}

/// Returns the view sample at which a primary ray hit the surface of a section, whose normal is
/// `normal`.
VOXDAG_HD inline ViewSample cut_view_sample(const RenderSetup& setup, Vec3d direction, int level,
                                            double depth, Vec3f normal) {
  ViewSample sample;
  sample.normal = sample.face = normal;
  sample.albedo = kCutAlbedo;
  sample.depth = static_cast<float>(depth);
  sample.cell_size = static_cast<float>(setup.grid.cell_size(level));
  sample.point = setup.camera.eye + direction * depth;
  const float hatch = setup.settings.hatch_period;
  if (hatch > 0 &&
      is_hatched((sample.point - setup.grid.origin) * (1 / setup.side()), normal, hatch))
    sample.albedo = kCutAlbedo * kHatchShade;
  return sample;
}

/// Returns the view sample at which a ray along `line` hit a cell. `depth` and `layers` as above;
/// `ray` is the line's, in the grid.
template <class Nodes, class Layers>
VOXDAG_HD inline ViewSample view_sample_of(const Nodes& nodes, const RenderSetup& setup,
                                           const SightLine& line, const GridRay& ray,
                                           const CellHit& cell, double depth, Layers& layers) {
  static_assert(!EsvoLayout<Nodes>, "see esvo_view_samples.hpp");
  const Hit hit = to_hit(ray, cell, setup.grid.levels, 0, HUGE_VALF);
  return voxel_view_sample(nodes, setup, line, hit, ray.to_world_t(static_cast<double>(cell.t)),
                           depth, layers);
}

/// Sets scratch.samples for all pixels of the tile. Returns the number of rays.
template <class Nodes, class Caster, class Scratch>
VOXDAG_HD inline int trace_view_samples(const Nodes& nodes, const Caster& caster,
                                        const RenderSetup& setup, const ViewTile& tile,
                                        Scratch& scratch) {
  caster.closest(
      tile.width * tile.height, [&](int pixel) { return primary_ray(setup, tile, pixel); },
      [&](int pixel, const GridRay& ray, const typename FoundBy<Nodes>::Type& cell, bool is_hit) {
        ViewSample& sample = scratch.samples[pixel];
        sample = ViewSample{};
        if (!is_hit) return;
        const double depth = ray.to_world_t(static_cast<double>(cell.t));
        const SightLine line = pixel_line(setup, tile, pixel);
        const Vec3f cut = cell.t == ray.t_min ? cut_normal(setup.section, ray) : Vec3f{};
        sample = dot(cut, cut) > 0
                     ? cut_view_sample(setup, line.direction, cell.level, depth, cut)
                     : view_sample_of(nodes, setup, line, ray, cell, depth, scratch.layers);
        sample.cell = {to_hit(ray, cell, setup.grid.levels, 0, HUGE_VALF).voxel, cell.level};
      });
  return tile.width * tile.height;
}

}  // namespace voxdag
