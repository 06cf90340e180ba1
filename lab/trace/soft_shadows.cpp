#include "lab/trace/soft_shadows.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>

#include "voxdag/cpu/cpu_scene.hpp"
#include "voxdag/cpu/tile_renderer.hpp"
#include "voxdag/render/render_plan.hpp"
#include "voxdag/render/render_tile.hpp"

namespace voxdag::lab {
namespace {

constexpr int kTile = 8;
constexpr int kLamp = 1;  // the sun is light 0

using Scratch = TileScratch<kTile * kTile>;

/// The surface that a tile of the picture shows.
struct TileSurface {
  ViewTile tile;
  std::vector<SurfacePoint> points;
};

/// Returns the surfaces of all tiles.
template <class Nodes, class Caster>
std::vector<TileSurface> find_surfaces(const Nodes& nodes, const Caster& caster,
                                       const RenderSetup& setup) {
  const std::vector<ViewTile> tiles = make_tiles(setup.camera.width, setup.camera.height, kTile);
  std::vector<TileSurface> surfaces(tiles.size());
  parallel_for(tiles.size(), [&](std::size_t i) {
    Scratch scratch;
    const ViewTile& tile = tiles[i];
    trace_view_samples(nodes, caster, setup, tile, scratch);
    surfaces[i].tile = tile;
    surfaces[i].points.resize(static_cast<std::size_t>(tile.pixels()));
    for (int pixel = 0; pixel < tile.pixels(); ++pixel)
      if (const ViewSample& sample = scratch.samples[pixel]; sample.is_hit())
        surfaces[i].points[static_cast<std::size_t>(pixel)] =
            make_surface_point(nodes, setup, sample, pixel_line(setup, tile, pixel));
  });
  return surfaces;
}

/// Finds the shadows of all surfaces; returns the number of rays.
template <class Nodes, class Caster>
std::uint64_t find_shadows(const Nodes& nodes, const Caster& caster, const RenderSetup& setup,
                           const std::vector<TileSurface>& surfaces) {
  std::atomic<std::uint64_t> rays{0};
  parallel_for(surfaces.size(), [&](std::size_t i) {
    Scratch scratch{};
    std::copy(surfaces[i].points.begin(), surfaces[i].points.end(), scratch.points);
    rays += static_cast<std::uint64_t>(
        trace_light(nodes, caster, setup, kLamp, surfaces[i].tile, scratch));
  });
  return rays;
}

template <class Work>
double seconds_of(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Adds the shadows of one view to a row.
void add_view(const CpuScene& scene, const Grid& grid, RenderOptions options, int repeat,
              SoftShadowRow& row) {
  LightSpec& lamp = options.lights.front();
  const Vec3d way = lamp.position - *options.view.eye;
  lamp.radius = row.light_size * std::sqrt(dot(way, way));
  options.beams = true;
  const RenderPlan with_beams(scene.voxels(), grid, options);
  options.beams = false;
  const RenderPlan without(scene.voxels(), grid, options);
  scene.visit([&](const auto& nodes, const auto& caster) {
    const std::vector<TileSurface> surfaces = find_surfaces(nodes, caster, without.setup());
    double best[2] = {HUGE_VAL, HUGE_VAL};
    for (int turn = 0; turn <= repeat; ++turn)  // the first turn warms up
      for (const bool beams : {true, false}) {
        const double seconds = seconds_of([&] {
          const std::uint64_t rays =
              find_shadows(nodes, caster, (beams ? with_beams : without).setup(), surfaces);
          if (turn == 0 && !beams) row.rays += rays;
        });
        if (turn > 0) best[beams] = std::min(best[beams], seconds);
      }
    row.beam_seconds += best[true];
    row.no_beam_seconds += best[false];
  });
}

}  // namespace

std::vector<SoftShadowRow> measure_soft_shadows(const VoxelSet& scene, const Grid& grid,
                                                const std::vector<View>& views,
                                                const RayOptions& options,
                                                const std::vector<double>& light_sizes, int repeat,
                                                Progress& progress) {
  std::vector<SoftShadowRow> rows;
  if (light_sizes.empty()) return rows;
  const CpuScene cpu_scene(scene);
  for (const double size : light_sizes) {
    SoftShadowRow row;
    row.light_size = size;
    for (const View& view : views) {
      progress.throw_if_cancelled();
      progress.report("soft shadows",
                      static_cast<double>(rows.size()) / static_cast<double>(light_sizes.size()));
      add_view(cpu_scene, grid, picture_options(scene, grid, view, options), repeat, row);
    }
    rows.push_back(row);
  }
  return rows;
}

}  // namespace voxdag::lab
