#pragma once
/// The primary rays of a tile at the voxels of a DAG.
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

/// Returns the view sample at which a primary ray hit a cell. `direction` is the ray's direction;
/// the ray ended at `hit`, at depth `depth`.
template <class Nodes>
VOXDAG_HD inline ViewSample voxel_view_sample(const Nodes& nodes, const RenderSetup& setup,
                                              Vec3d direction, const Hit& hit, double depth) {
  const RenderSettings& settings = setup.settings;
  const int shift = setup.grid.levels - hit.level;
  const double cell_size = setup.grid.cell_size(hit.level);
  const Vec3f view = -static_cast<Vec3f>(normalized(direction));
  const Vec3f face = hit.face == Face::kNone ? view : static_cast<Vec3f>(face_normal(hit.face));
  const float cell_pixels = static_cast<float>(cell_size / (setup.camera.pixel_size() * depth));
  const float cube = smooth_step(settings.cube_pixels / 2, settings.cube_pixels, cell_pixels);
  ViewSample sample;
  sample.normal = face;
  const Vec3i at{hit.voxel.x >> shift, hit.voxel.y >> shift, hit.voxel.z >> shift};
  if (cube < 1 && hit.level >= 2) {
    const Vec3f smooth = surface_normal(nodes, hit.level, at, view, face);
    sample.normal = normalized(mix(smooth, face, cube));
  }
  sample.face = sample.normal;
  sample.albedo = settings.albedo;
  set_stored_look(setup.look, at, hit.level, view, face, sample);
  sample.depth = static_cast<float>(depth);
  sample.cell_size = static_cast<float>(cell_size);
  // The surface's plane meets the cell, so the entered face lies at most this far below the plane.
  const float below = cube_height(sample.face) - dot(sample.face, face);
  const double lift = below > 0 ? static_cast<double>(below) * cell_size : 0.0;
  sample.point = setup.camera.eye + direction * depth + static_cast<Vec3d>(sample.face) * lift;
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

/// Sets scratch.samples for all pixels of the tile. Returns the number of rays.
template <class Nodes, class Caster, class Scratch>
VOXDAG_HD inline int trace_view_samples(const Nodes& nodes, const Caster& caster,
                                        const RenderSetup& setup, const ViewTile& tile,
                                        Scratch& scratch) {
  static_assert(!EsvoLayout<Nodes>, "see esvo_view_samples.hpp");
  caster.closest(
      tile.width * tile.height, [&](int pixel) { return primary_ray(setup, tile, pixel); },
      [&](int pixel, const GridRay& ray, const CellHit& cell, bool is_hit) {
        ViewSample& sample = scratch.samples[pixel];
        sample = ViewSample{};
        if (!is_hit) return;
        const Hit hit = to_hit(ray, cell, setup.grid.levels, 0, HUGE_VALF);
        const double depth = ray.to_world_t(static_cast<double>(cell.t));
        const Vec3d direction = pixel_direction(setup, tile, pixel);
        const Vec3f cut = cell.t == ray.t_min ? cut_normal(setup.section, ray) : Vec3f{};
        if (dot(cut, cut) > 0) {
          sample = cut_view_sample(setup, direction, cell.level, depth, cut);
          return;
        }
        sample = voxel_view_sample(nodes, setup, direction, hit, depth);
      });
  return tile.width * tile.height;
}

}  // namespace voxdag
