#include "lab/trace/bench_trace.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "lab/rays/cuda_runner.hpp"
#include "lab/rays/trace_measure.hpp"
#include "lab/rivals/embree_rival.hpp"
#include "lab/rivals/tinybvh_rival.hpp"
#include "lab/rivals/trace_program_rival.hpp"
#include "lab/trace/trace_casters.hpp"

namespace voxdag::lab {
namespace {

/// Sums of times and counts over views.
struct Sums {
  double seconds = 0, agreeing = 0;
  std::vector<double> view_rates;                   ///< Million rays per second.
  std::uint64_t bytes = 0;                          ///< Of a rival's structure.
  std::optional<double> same_place = std::nullopt;  ///< Rays; see RivalRate::same_place.

  void add(double more_seconds, double more_agreeing) {
    seconds += more_seconds;
    agreeing += more_agreeing;
  }
  void add_view(double rays, const Sums& view) {
    add(view.seconds, view.agreeing);
    if (view.same_place) same_place = same_place.value_or(0) + *view.same_place;
    view_rates.push_back(rays / view.seconds * 1e-6);
  }
};

struct RowSums {
  Sums ours;
  double rays = 0, hits = 0, cells = 0, bytes = 0;
  std::map<std::string, Sums> rivals;  ///< Sorted by name, for a fixed order.
};

/// Measures a set with the casts of voxdag and of the rivals, and adds up the times.
void measure_set(const Grid& grid, const TraceLayout& layout, const TraceRunner& ours,
                 const std::vector<CastRay>& casts, std::vector<TraceRunner> runners, int repeat,
                 RowSums& sums) {
  constexpr std::size_t kCounted = 50'000;
  const WalkCost cost = layout.cost(sample_of(casts, kCounted));
  runners.insert(runners.begin(), ours);
  const std::vector<Measured> measured = measure(runners, casts.size(), repeat);
  const auto count = static_cast<double>(casts.size());
  sums.rays += count;
  sums.cells += cost.cells * count;
  sums.bytes += cost.bytes * count;
  sums.ours.add_view(count, {measured[0].seconds, count, {}});
  sums.hits += static_cast<double>(
      std::count(measured[0].hits.begin(), measured[0].hits.end(), std::uint8_t{1}));
  const auto embree = std::find_if(runners.begin(), runners.end(), [](const TraceRunner& runner) {
    return runner.name == "embree_single";
  });
  std::map<std::string, Sums> best;  // the fastest of runners with the same name
  for (std::size_t i = 1; i < runners.size(); ++i) {
    Sums s{
        measured[i].seconds, static_cast<double>(agreeing(measured[0].hits, measured[i].hits)), {}};
    if (embree != runners.end() && runners[i].closest_t && runners[i].name != embree->name)
      s.same_place = static_cast<double>(hits_at_same_place(grid, casts, *embree, runners[i]));
    const auto [at, is_new] = best.try_emplace(runners[i].name, s);
    if (!is_new && s.seconds < at->second.seconds) at->second = s;
  }
  for (const auto& [name, s] : best) sums.rivals[name].add_view(count, s);
}

TraceRow row_of(const TraceScene& scene, const std::string& layout_name, std::uint64_t layout_bytes,
                RayClass rays, const RowSums& sums) {
  TraceRow row;
  row.scene = scene.name;
  row.layout = layout_name;
  row.levels = scene.grid.levels;
  row.rays = rays;
  row.count = static_cast<std::uint64_t>(sums.rays);
  row.layout_bytes = layout_bytes;
  row.view_mrays_per_second = sums.ours.view_rates;
  row.mrays_per_second = sums.rays / sums.ours.seconds * 1e-6;
  row.hit_part = sums.hits / sums.rays;
  row.cells_per_ray = sums.cells / sums.rays;
  row.bytes_per_ray = sums.bytes / sums.rays;
  for (const auto& [name, s] : sums.rivals)
    row.rivals.push_back({name, sums.rays / s.seconds * 1e-6, s.agreeing / sums.rays, s.view_rates,
                          s.bytes,
                          s.same_place ? std::optional(*s.same_place / sums.rays) : std::nullopt});
  return row;
}

/// Returns the rivals that can cast rays of the scene.
std::vector<std::unique_ptr<Rival>> rivals_for(const TraceScene& scene, const TracePlan& plan) {
  std::vector<std::unique_ptr<Rival>> rivals;
  if (scene.mesh != nullptr && EmbreeRival::is_available())
    rivals.push_back(std::make_unique<EmbreeRival>(*scene.mesh));
  if (scene.mesh != nullptr)
    if (std::unique_ptr<Rival> tinybvh = make_tinybvh_rival(*scene.mesh))
      rivals.push_back(std::move(tinybvh));
  const auto add_program = [&](const char* name, const std::string& program, std::size_t rays) {
    if (!program.empty() && !scene.file.empty())
      rivals.push_back(
          std::make_unique<TraceProgramRival>(name, program, rays, scene.file, scene.voxels));
  };
  add_program("openvdb", plan.openvdb_program, 100'000);
  add_program("nanovdb_cuda", plan.nanovdb_program, 4'000'000);  // enough to fill a device
  return rivals;
}

/// Casts the rays of a view at the scene's ESVO, as a rival.
class EsvoRival {
 public:
  /// Returns the casts of `set`. Primary rays with beams start where the ESVO's own beams end.
  /// They are valid until the next call.
  EsvoRival(const TraceScene& scene, const TracePlan& plan)
      : scene_(scene),
        plan_(plan),
        layout_(make_trace_layout("contours", *scene.esvo)),
        on_device_(load_on_device(plan.device, *scene.esvo, layout_->device_layout())) {}

  bool on_cuda() const { return on_device_.has_value(); }
  /// Casts on the CPU from now on.
  void leave_device() { on_device_.reset(); }

  TraceRunner prepare(const View& view, RayClass rays, const std::vector<CastRay>& set) {
    if (rays != RayClass::kPrimaryBeams) return runner_of(rays, set, {});
    beams_ = std::make_unique<BeamPass>(
        *scene_.esvo, scene_.grid, picture_options(*scene_.esvo, scene_.grid, view, plan_.rays),
        plan_.rays.beam_pixels);
    beams_->run();
    if (on_device_) {
      const TimedBeams beams(*on_device_, beams_->setup());
      casts_ = primary_rays(beams_->setup(), beams.starts().data());
      return runner_of(rays, casts_, beams);
    }
    casts_ = primary_rays(beams_->setup(), beams_->starts());
    TraceRunner runner = runner_of(rays, casts_, {});
    runner.before = [this] { beams_->run(); };
    return runner;
  }

 private:
  TraceRunner runner_of(RayClass rays, const std::vector<CastRay>& set,
                        const std::optional<TimedBeams>& beams) const {
    TraceRunner runner =
        on_device_ ? cuda_runner(*on_device_, rays, set, beams) : layout_->runner(rays, set);
    runner.name = "esvo";
    return runner;
  }

  const TraceScene& scene_;
  const TracePlan& plan_;
  std::unique_ptr<TraceLayout> layout_;
  std::optional<DeviceScene> on_device_;
  std::unique_ptr<BeamPass> beams_;
  std::vector<CastRay> casts_;
};

/// Casts on the CPU unless the ESVO and all layouts fit into the memory of the device.
void use_one_device(EsvoRival& esvo, std::vector<std::optional<DeviceScene>>& device_scenes) {
  bool all_fit = esvo.on_cuda();
  for (const auto& scene : device_scenes) all_fit = all_fit && scene.has_value();
  if (all_fit) return;
  esvo.leave_device();
  for (auto& scene : device_scenes) scene.reset();
}

}  // namespace

void bench_trace(const TraceScene& scene, const TracePlan& plan, Progress& progress,
                 TraceResults& results) {
  results.threads = tbb::this_task_arena::max_concurrency();
  results.rays = plan.rays;
  const double aspect = static_cast<double>(plan.rays.width) / plan.rays.height;
  const std::vector<View> views = plan.path_views.empty()
                                      ? bench_views(scene.voxels, scene.grid, aspect, plan.views)
                                      : plan.path_views;
  std::optional<EsvoRival> esvo;
  if (scene.esvo) esvo.emplace(scene, plan);
  const std::vector<std::unique_ptr<Rival>> rivals = rivals_for(scene, plan);
  std::vector<std::string> names = plan.layouts;
  if (names.empty()) names = {trace_layouts(scene.voxels).front()};
  std::vector<std::unique_ptr<TraceLayout>> layouts;
  layouts.reserve(names.size());
  for (const std::string& name : names) layouts.push_back(make_trace_layout(name, scene.voxels));
  std::vector<std::optional<DeviceScene>> device_scenes;
  for (const auto& layout : layouts) {
    device_scenes.push_back(load_on_device(plan.device, scene.voxels, layout->device_layout()));
  }
  if (esvo) use_one_device(*esvo, device_scenes);
  for (const std::optional<DeviceScene>& device_scene : device_scenes)
    if (device_scene) results.cuda_device = device_scene->device().name;

  std::vector<std::array<RowSums, kRayClasses.size()>> sums(layouts.size());
  const double steps = static_cast<double>(views.size() * kRayClasses.size());
  std::size_t done = 0;
  for (const View& view : views) {
    BeamPass beams(scene.voxels, scene.grid,
                   picture_options(scene.voxels, scene.grid, view, plan.rays),
                   plan.rays.beam_pixels);
    beams.run();
    const RecordedRays recorded = record_rays(scene.voxels, beams, plan.rays);
    for (const RayClass rays : kRayClasses) {
      progress.throw_if_cancelled();
      progress.report(scene.name, static_cast<double>(done) / steps, done);
      ++done;
      const std::vector<CastRay>& casts = recorded.of(rays);
      if (casts.empty()) continue;
      // Rivals have no beams: they cast the primary rays from the eye.
      const bool with_beams = rays == RayClass::kPrimaryBeams;
      const std::vector<CastRay>& whole = with_beams ? recorded.of(RayClass::kPrimary) : casts;
      std::vector<TraceRunner> rival_runners;
      for (const auto& rival : rivals)
        for (TraceRunner& runner : rival->prepare(scene.grid, {rays, whole}))
          rival_runners.push_back(std::move(runner));
      if (esvo) rival_runners.push_back(esvo->prepare(view, rays, casts));
      for (std::size_t i = 0; i < layouts.size(); ++i) {
        std::optional<TimedBeams> device_beams;
        std::vector<CastRay> device_casts;
        if (device_scenes[i] && with_beams) {
          device_beams.emplace(*device_scenes[i], beams.setup());
          device_casts = primary_rays(beams.setup(), device_beams->starts().data());
        }
        // The beams of the CPU and of the device differ.
        const std::vector<CastRay>& set = device_beams ? device_casts : casts;
        TraceRunner ours = layouts[i]->runner(rays, set);
        if (with_beams) ours.before = [&beams] { beams.run(); };
        std::vector<TraceRunner> others = rival_runners;
        if (device_scenes[i]) {
          others.push_back(ours);
          others.back().name = "voxdag_cpu";
          ours = cuda_runner(*device_scenes[i], rays, set, device_beams);
        }
        measure_set(scene.grid, *layouts[i], ours, set, others, plan.repeat,
                    sums[i][static_cast<std::size_t>(rays)]);
      }
    }
  }
  for (const SoftShadowRow& row : measure_soft_shadows(scene.voxels, scene.grid, views, plan.rays,
                                                       plan.light_sizes, plan.repeat, progress))
    results.soft_shadows.push_back({scene.name, scene.grid.levels, row});
  for (const auto& rival : rivals)
    for (const RivalTime& time : rival->cast_all(plan.repeat, progress))
      for (auto& layout_sums : sums) {
        Sums& s = layout_sums[static_cast<std::size_t>(time.rays_class)].rivals[rival->name()];
        s.add(time.seconds, time.agreeing);
        s.bytes = time.bytes;
      }
  for (std::size_t i = 0; i < layouts.size(); ++i) {
    const std::uint64_t bytes = device_scenes[i] ? layouts[i]->device_bytes() : layouts[i]->bytes();
    for (const RayClass rays : kRayClasses) {
      const RowSums& s = sums[i][static_cast<std::size_t>(rays)];
      if (s.rays == 0) continue;
      results.rows.push_back(row_of(scene, names[i], bytes, rays, s));
      results.rows.back().on_cuda = device_scenes[i].has_value();
    }
  }
}

}  // namespace voxdag::lab
