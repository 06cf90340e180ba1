#include "lab/rays/trace_rays.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "voxdag/core/morton.hpp"
#include "voxdag/cpu/beam_starts.hpp"
#include "voxdag/render/esvo_view_samples.hpp"
#include "voxdag/render/primary_beams.hpp"
#include "voxdag/render/render_plan.hpp"
#include "voxdag/render/render_tile.hpp"

namespace voxdag::lab {
namespace {

constexpr int kTile = 4;

/// A caster that records the rays that meet the grid. It reports no hits.
class RecordingCaster {
 public:
  explicit RecordingCaster(std::vector<CastRay>& rays) : rays_(rays) {}

  template <class MakeRay, class OnResult>
  void any(int count, const MakeRay& make_ray, const OnResult& on_result) const {
    for (int i = 0; i < count; ++i) {
      const CastRay ray = make_ray(i);
      if (!ray.ray.misses()) rays_.push_back(ray);
      on_result(i, false);
    }
  }

 private:
  std::vector<CastRay>& rays_;
};

/// Returns a lamp in free space in front of the camera, above it and to its right.
template <class Nodes>
LightSpec lamp_near(const Nodes& nodes, const Grid& grid, const Camera& camera) {
  const Vec3d way =
      normalized(camera.forward + normalized(camera.up) * 0.7 + normalized(camera.right) * 0.3);
  const double side = grid.side();
  double free_way = 0.5 * side;
  const GridRay ray = make_grid_ray(grid, camera.eye, way, 0, free_way);
  CellHit cell;
  if (cast(nodes, ray, StopAtVoxels{}, cell))
    free_way = std::max(ray.to_world_t(static_cast<double>(cell.t)), 0.0);
  LightSpec lamp;
  lamp.kind = LightKind::kSphere;
  lamp.position = camera.eye + way * (0.6 * free_way);
  lamp.radius = 0.2 * free_way + 1e-6 * side;
  return lamp;
}

std::vector<ViewTile> tiles_in_order(const Camera& camera) {
  std::vector<ViewTile> tiles;
  for (int y = 0; y < camera.height; y += kTile)
    for (int x = 0; x < camera.width; x += kTile)
      tiles.push_back({x, y, std::min(kTile, camera.width - x), std::min(kTile, camera.height - y),
                       0, 0.5, 0.5});
  const auto code = [](const ViewTile& tile) {
    return morton_encode({tile.x / kTile, tile.y / kTile, 0});
  };
  std::sort(tiles.begin(), tiles.end(),
            [&](const ViewTile& a, const ViewTile& b) { return code(a) < code(b); });
  return tiles;
}

}  // namespace

std::string_view name_of(RayClass rays) {
  static constexpr std::array<std::string_view, kRayClasses.size()> kNames{
      "primary", "primary_beams", "shadow", "soft", "ao"};
  return kNames[static_cast<std::size_t>(rays)];
}

struct BeamPass::State {
  State(const VoxelSet& scene_in, const Grid& grid, const RenderOptions& options, int pixels)
      : scene(scene_in), plan(scene_in, grid, options), beam_pixels(pixels) {}

  VoxelSet scene;
  RenderPlan plan;
  int beam_pixels;
  std::vector<float> starts;
};

BeamPass::BeamPass(const VoxelSet& scene, const Grid& grid, const RenderOptions& options,
                   int beam_pixels)
    : state_(std::make_unique<State>(scene, grid, options, beam_pixels)) {}

BeamPass::~BeamPass() = default;

void BeamPass::run() {
  visit_nodes(state_->scene, [&](const auto& nodes) {
    find_beam_starts(nodes, state_->plan.setup(), state_->starts, state_->beam_pixels);
  });
}

const float* BeamPass::starts() const { return state_->starts.data(); }
const RenderSetup& BeamPass::setup() const { return state_->plan.setup(); }

RenderOptions picture_options(const VoxelSet& scene, const Grid& grid, const View& view,
                              const RayOptions& ray_options) {
  RenderOptions options;
  options.width = ray_options.width;
  options.height = ray_options.height;
  options.view = {view.eye, view.target, view.up, view.vertical_fov_degrees};
  options.shadow_samples = ray_options.shadow_samples;
  options.occlusion_samples = ray_options.occlusion_samples;
  options.lod_pixels = ray_options.lod_pixels;
  options.occlusion_cone = ray_options.occlusion_cone;
  options.sun = ray_options.sun;
  options.sun_degrees = 0;
  options.beams = false;  // rivals have no beams towards lamps
  const Camera camera = make_camera(view, options.width, options.height);
  options.lights = {
      visit_nodes(scene, [&](const auto& nodes) { return lamp_near(nodes, grid, camera); })};
  return options;
}

namespace {

/// Returns evenly spread tiles with a total of about `most_rays` rays.
std::vector<ViewTile> some_tiles(const Camera& camera, int rays_per_pixel, std::size_t most_rays) {
  constexpr std::size_t kGroup = 4;  // number of tiles that form 8×8 pixels
  const std::vector<ViewTile> tiles = tiles_in_order(camera);
  const std::size_t wanted =
      tiles.size() * kTile * kTile * static_cast<std::size_t>(rays_per_pixel);
  const std::size_t step = (wanted + most_rays - 1) / most_rays;
  std::vector<ViewTile> some;
  for (std::size_t i = 0; i < tiles.size(); ++i)
    if (i / kGroup % step == step / 2) some.push_back(tiles[i]);
  return some;
}

/// Returns the rays that add(tile, rays) appends for each tile, in the order of the tiles.
template <class AddRays>
std::vector<CastRay> rays_of(const std::vector<ViewTile>& tiles, const AddRays& add) {
  constexpr std::size_t kRun = 256;
  std::vector<std::vector<CastRay>> parts((tiles.size() + kRun - 1) / kRun);
  parallel_for(parts.size(), [&](std::size_t part) {
    for (std::size_t i = part * kRun; i < std::min(tiles.size(), (part + 1) * kRun); ++i)
      add(tiles[i], parts[part]);
  });
  std::size_t count = 0;
  for (const std::vector<CastRay>& part : parts) count += part.size();
  std::vector<CastRay> rays;
  rays.reserve(count);
  for (const std::vector<CastRay>& part : parts) rays.insert(rays.end(), part.begin(), part.end());
  return rays;
}

/// Returns the shadow or occlusion rays of the surface in a tile.
template <class Nodes>
void record_tile(const Nodes& nodes, const RenderSetup& plain, const RenderSetup& with_beams,
                 RayClass c, const ViewTile& tile, std::vector<CastRay>& rays) {
  const RecordingCaster record(rays);
  TileScratch<kTile * kTile> scratch;
  trace_view_samples(nodes, ScalarCaster<Nodes>(nodes), with_beams, tile, scratch);
  for (int pixel = 0; pixel < tile.pixels(); ++pixel) {
    const ViewSample& sample = scratch.samples[pixel];
    scratch.points[pixel] = {};
    if (sample.is_hit())
      scratch.points[pixel] =
          make_surface_point(nodes, plain, sample, pixel_line(plain, tile, pixel));
  }
  if (c == RayClass::kAo)
    trace_occlusion(record, plain, tile, scratch);
  else  // the sun is light 0, the lamp light 1
    trace_light(nodes, record, plain, c == RayClass::kShadow ? 0 : 1, tile, scratch);
}

}  // namespace

std::vector<CastRay> primary_rays(const RenderSetup& plain, const float* beam_starts) {
  RenderSetup with_beams = plain;
  with_beams.beam_starts = beam_starts;
  return rays_of(tiles_in_order(plain.camera), [&](const ViewTile& tile, auto& rays) {
    for (int pixel = 0; pixel < tile.pixels(); ++pixel) {
      const CastRay ray = primary_ray(plain, tile, pixel);
      if (ray.ray.misses()) continue;
      rays.push_back(beam_starts == nullptr ? ray : primary_ray(with_beams, tile, pixel));
    }
  });
}

RecordedRays record_rays(const VoxelSet& scene, const BeamPass& beams, const RayOptions& options) {
  const RenderSetup& plain = beams.setup();
  RenderSetup with_beams = plain;
  with_beams.beam_starts = beams.starts();
  RecordedRays recorded;
  const auto rays = [&](RayClass c) -> std::vector<CastRay>& {
    return recorded.rays[static_cast<std::size_t>(c)];
  };
  rays(RayClass::kPrimary) = primary_rays(plain, nullptr);
  rays(RayClass::kPrimaryBeams) = primary_rays(plain, beams.starts());
  for (const RayClass c : {RayClass::kShadow, RayClass::kSoft, RayClass::kAo}) {
    const int per_pixel = c == RayClass::kSoft ? options.shadow_samples
                          : c == RayClass::kAo ? options.occlusion_samples
                                               : 1;
    const std::vector<ViewTile> tiles = some_tiles(plain.camera, per_pixel, options.most_rays);
    visit_nodes(scene, [&](const auto& nodes) {
      rays(c) = rays_of(tiles, [&](const ViewTile& tile, auto& of_tile) {
        record_tile(nodes, plain, with_beams, c, tile, of_tile);
      });
    });
  }
  return recorded;
}

std::vector<View> bench_views(const VoxelSet& scene, const Grid& grid, double aspect, int count) {
  const View usual = frame_scene(scene, grid, aspect, {});
  std::vector<View> views{usual};
  for (const View& view : scene_views(scene, grid, aspect, count))
    if (static_cast<int>(views.size()) < count && view.eye != usual.eye) views.push_back(view);
  return views;
}

WorldRay to_world_ray(const Grid& grid, const GridRay& ray) {
  const double side = grid.side();
  WorldRay world;
  for (int axis = 0; axis < 3; ++axis) {
    const bool is_mirrored = (ray.mirrored >> axis & 1u) != 0;
    const double p = static_cast<double>(ray.origin[axis]);
    world.origin[axis] = grid.origin[axis] + ((is_mirrored ? 3 - p : p) - 1) * side;
    const double slope = side / static_cast<double>(ray.inverse[axis]);
    world.direction[axis] = (ray.parallel >> axis & 1u) != 0 ? 0.0 : is_mirrored ? slope : -slope;
  }
  world.t_min = ray.t_min;
  world.t_max = ray.t_max;
  return world;
}

}  // namespace voxdag::lab
