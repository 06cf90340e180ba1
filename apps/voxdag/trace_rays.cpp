#include "trace_rays.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "voxdag/core/morton.hpp"
#include "voxdag/cpu/beam_starts.hpp"
#include "voxdag/render/esvo_view_samples.hpp"
#include "voxdag/render/primary_beams.hpp"
#include "voxdag/render/render_plan.hpp"
#include "voxdag/render/render_tile.hpp"

namespace voxdag {
namespace {

constexpr int kTile = 4;

/// A caster that keeps rays and answers that they meet nothing.
class RecordingCaster {
 public:
  explicit RecordingCaster(std::vector<CastRay>& rays) : rays_(rays) {}

  template <class MakeRay, class OnResult>
  void any(int count, const MakeRay& make_ray, const OnResult& on_result) const {
    for (int i = 0; i < count; ++i) {
      rays_.push_back(make_ray(i));
      on_result(i, false);
    }
  }

 private:
  std::vector<CastRay>& rays_;
};

/// A lamp in free space ahead of the camera, above and to the right.
template <class Nodes>
LightSpec lamp_near(const Nodes& nodes, const Grid& grid, const Camera& camera) {
  const Vec3d way =
      normalized(camera.forward + normalized(camera.up) * 0.7 + normalized(camera.right) * 0.3);
  const double side = grid.voxel_size * static_cast<double>(grid.resolution());
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

/// Takes out of both sets the pixels whose plain ray misses the grid.
void drop_misses(std::vector<CastRay>& plain, std::vector<CastRay>& with_beams) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    if (plain[i].ray.misses()) continue;
    plain[kept] = plain[i];
    with_beams[kept++] = with_beams[i];
  }
  plain.resize(kept);
  with_beams.resize(kept);
}

}  // namespace

std::string_view name_of(RayClass rays) {
  static constexpr std::array<std::string_view, kRayClasses.size()> kNames{
      "primary", "primary_beams", "shadow", "soft", "ao"};
  return kNames[static_cast<std::size_t>(rays)];
}

struct BeamPass::State {
  State(const VoxelScene& scene_in, const Grid& grid, const RenderOptions& options)
      : scene(scene_in), plan(scene_in, grid, options) {}

  VoxelScene scene;
  RenderPlan plan;
  std::vector<float> starts;
};

BeamPass::BeamPass(const VoxelScene& scene, const Grid& grid, const RenderOptions& options)
    : state_(std::make_unique<State>(scene, grid, options)) {}

BeamPass::~BeamPass() = default;

void BeamPass::run() {
  state_->scene.visit_nodes(
      [&](const auto& nodes) { find_beam_starts(nodes, state_->plan.setup(), state_->starts); });
}

const float* BeamPass::starts() const { return state_->starts.data(); }
const RenderSetup& BeamPass::setup() const { return state_->plan.setup(); }

RenderOptions picture_options(const VoxelScene& scene, const Grid& grid, const View& view,
                              const RayOptions& ray_options) {
  RenderOptions options;
  options.width = ray_options.width;
  options.height = ray_options.height;
  options.view = {view.eye, view.target, view.up, view.vertical_fov_degrees};
  options.shadow_samples = ray_options.shadow_samples;
  options.occlusion_samples = ray_options.occlusion_samples;
  options.lod_pixels = ray_options.lod_pixels;
  options.occlusion_cone = ray_options.occlusion_cone;
  options.sun_degrees = 0;
  options.beams = false;  // those towards lamps, which rivals do not have
  const Camera camera = make_camera(view, options.width, options.height);
  options.lights = {
      scene.visit_nodes([&](const auto& nodes) { return lamp_near(nodes, grid, camera); })};
  return options;
}

namespace {

template <class Nodes>
RecordedRays record_rays_at(const Nodes& nodes, const BeamPass& beams, const RayOptions& options) {
  constexpr std::size_t kGroup = 4;  // tiles that make 8x8 pixels
  RecordedRays recorded;
  const RenderSetup& plain = beams.setup();
  RenderSetup with_beams = plain;
  with_beams.beam_starts = beams.starts();
  const std::vector<ViewTile> tiles = tiles_in_order(plain.camera);
  const auto scratch = std::make_unique<TileScratch<kTile * kTile>>();
  const std::size_t pixels = tiles.size() * kTile * kTile;
  for (const RayClass c : kRayClasses) {
    std::vector<CastRay>& rays = recorded.rays[static_cast<std::size_t>(c)];
    const int per_pixel = c == RayClass::kSoft ? options.shadow_samples
                          : c == RayClass::kAo ? options.occlusion_samples
                                               : 1;
    const std::size_t wanted = pixels * static_cast<std::size_t>(per_pixel);
    const std::size_t step =
        is_closest(c) ? 1 : (wanted + options.most_rays - 1) / options.most_rays;
    const RecordingCaster record(rays);
    for (std::size_t i = 0; i < tiles.size(); ++i) {
      if (i / kGroup % step != step / 2) continue;
      const ViewTile& tile = tiles[i];
      if (is_closest(c)) {
        for (int pixel = 0; pixel < tile.pixels(); ++pixel)
          rays.push_back(primary_ray(c == RayClass::kPrimary ? plain : with_beams, tile, pixel));
        continue;
      }
      trace_view_samples(nodes, ScalarCaster<Nodes>(nodes), with_beams, tile, *scratch);
      for (int pixel = 0; pixel < tile.width * tile.height; ++pixel) {
        const ViewSample& sample = scratch->samples[pixel];
        scratch->points[pixel] = {};
        if (sample.is_hit())
          scratch->points[pixel] =
              make_surface_point(nodes, plain, sample, pixel_direction(plain, tile, pixel));
      }
      if (c == RayClass::kAo)
        trace_occlusion(record, plain, tile, *scratch);
      else  // the sun is light 0, the lamp light 1
        trace_light(nodes, record, plain, c == RayClass::kShadow ? 0 : 1, tile, *scratch);
    }
    if (!is_closest(c)) std::erase_if(rays, [](const CastRay& ray) { return ray.ray.misses(); });
  }
  drop_misses(recorded.rays[static_cast<std::size_t>(RayClass::kPrimary)],
              recorded.rays[static_cast<std::size_t>(RayClass::kPrimaryBeams)]);
  return recorded;
}

}  // namespace

RecordedRays record_rays(const VoxelScene& scene, const BeamPass& beams,
                         const RayOptions& options) {
  return scene.visit_nodes(
      [&](const auto& nodes) { return record_rays_at(nodes, beams, options); });
}

std::vector<View> bench_views(const VoxelScene& scene, const Grid& grid, double aspect, int count) {
  const View usual = frame_scene(scene, grid, aspect, {});
  std::vector<View> views{usual};
  for (const View& view : scene_views(scene, grid, aspect, count))
    if (static_cast<int>(views.size()) < count && view.eye != usual.eye) views.push_back(view);
  return views;
}

WorldRay to_world_ray(const Grid& grid, const GridRay& ray) {
  const double side = grid.voxel_size * static_cast<double>(grid.resolution());
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

}  // namespace voxdag
