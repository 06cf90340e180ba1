/// Measures the rays of `voxdag bench esvo`: Table 2, and silhouettes against the mesh.
#include <tbb/task_arena.h>

#include <cmath>
#include <map>
#include <memory>
#include <optional>

#include "bench/esvo/bench_esvo.hpp"
#include "bench/rays/caster_runner.hpp"
#include "bench/rays/trace_measure.hpp"
#include "bench/rays/trace_rays.hpp"
#include "bench/rivals/embree_rival.hpp"
#include "voxdag/cpu/packets/packet_caster.hpp"
#include "voxdag/file/esvo_file.hpp"
#include "voxdag/readers/read_mesh.hpp"

namespace voxdag {
namespace {

constexpr auto kTriangles = static_cast<std::size_t>(EsvoForm::kTriangles);
constexpr auto kCubes = static_cast<std::size_t>(EsvoForm::kCubes);
constexpr auto kContours = static_cast<std::size_t>(EsvoForm::kContours);
constexpr auto kContoursBeams = static_cast<std::size_t>(EsvoForm::kContoursBeams);
constexpr auto kCoarseContours = static_cast<std::size_t>(EsvoForm::kCoarseContours);
constexpr auto kCoarseContoursBeams = static_cast<std::size_t>(EsvoForm::kCoarseContoursBeams);

/// Both forms of a scene at one resolution.
struct BuiltPair {
  int levels = 0;
  const EsvoBuildRun* contours = nullptr;
  const EsvoBuildRun* cubes = nullptr;
};

std::vector<BuiltPair> pairs_of(const EsvoBenchResults& results, const std::string& scene) {
  std::map<int, BuiltPair> pairs;
  for (const EsvoBuildRun& run : results.builds) {
    if (run.scene != scene || !run.failure.empty()) continue;
    BuiltPair& pair = pairs[run.levels];
    pair.levels = run.levels;
    (run.with_contours ? pair.contours : pair.cubes) = &run;
  }
  std::vector<BuiltPair> complete;
  for (const auto& [levels, pair] : pairs)
    if (pair.contours != nullptr && pair.cubes != nullptr) complete.push_back(pair);
  return complete;
}

/// The primary rays of a view, with and without beams.
struct PrimaryRays {
  PrimaryRays(const EsvoView& esvo, const Grid& grid, const View& view, ImageSize size,
              float lod_pixels)
      : beams(esvo, grid, picture_options(esvo, grid, view, options(size, lod_pixels))) {
    beams.run();
    RecordedRays recorded = record_rays(esvo, beams, options(size, lod_pixels));
    plain = std::move(recorded.rays[static_cast<std::size_t>(RayClass::kPrimary)]);
    with_beams = std::move(recorded.rays[static_cast<std::size_t>(RayClass::kPrimaryBeams)]);
  }

  static RayOptions options(ImageSize size, float lod_pixels) {
    RayOptions options;
    options.width = size.width;
    options.height = size.height;
    options.lod_pixels = lod_pixels;
    options.most_rays = 1;  // shadow and occlusion rays are not used
    return options;
  }

  BeamPass beams;
  std::vector<CastRay> plain, with_beams;
};

template <class Nodes>
TraceRunner esvo_runner(const EsvoView& esvo, const std::vector<CastRay>& casts) {
  return runner_of(PacketCaster(Nodes(esvo)), RayClass::kPrimary, casts);
}

struct FormSums {
  double seconds = 0, agreeing = 0;
};

/// The targets of the rays, all in the same cube.
struct Octrees {
  EsvoFile contours, cubes;
  std::optional<EsvoFile> coarse;  ///< Contours whose silhouettes are as good as the cubes'.
};

class SceneRays {
 public:
  SceneRays(const EsvoBenchPlan& plan, const EsvoBenchScene& scene,
            const std::filesystem::path& mesh_file, Progress& progress, EsvoBenchResults& results)
      : plan_(plan), scene_(scene), progress_(progress), results_(results) {
    pairs_ = pairs_of(results, scene.name);
    if (pairs_.empty()) return;
    if (scene.is_plain() && EmbreeRival::is_available())
      embree_.emplace(read_mesh(mesh_file, &progress));
    const EsvoFile finest(pairs_.back().contours->file);
    views_ = bench_views(finest.view(), finest.grid(), 4.0 / 3, plan.views);
  }

  /// Measures the rays of all forms. Chooses the coarse grid by the measured silhouettes.
  void rates() {
    if (pairs_.empty()) return;
    const BuiltPair& pair = pairs_.back();
    Octrees octrees{EsvoFile(pair.contours->file), EsvoFile(pair.cubes->file), {}};
    const int coarse_at = coarse_levels(results_.silhouettes, scene_.name);
    for (const BuiltPair& other : pairs_)
      if (other.levels == coarse_at) octrees.coarse.emplace(other.contours->file);
    for (const ImageSize size : plan_.sizes) {
      EsvoRateRow row;
      row.scene = scene_.name;
      row.paper = pair.contours->paper;
      row.levels = pair.levels;
      row.size = size;
      std::array<FormSums, kEsvoForms.size()> sums;
      for (const View& view : views_) {
        step("casting at " + scene_.name);
        row.rays += add_view(octrees, view, size, sums);
      }
      const auto count = static_cast<double>(row.rays);
      for (std::size_t form = 0; form < kEsvoForms.size(); ++form) {
        const bool is_measured =
            form == kTriangles ? embree_.has_value() : form < kCoarseContours || octrees.coarse;
        row.mrays_per_second[form] = is_measured ? count / sums[form].seconds * 1e-6 : NAN;
        row.agreement[form] = embree_ && is_measured ? sums[form].agreeing / count : NAN;
      }
      if (row.rays == 0) continue;
      step("pictures of " + scene_.name);
      row.seconds = picture_cost(octrees.contours, views_, size, plan_.lod_pixels, plan_.repeat);
      results_.rates.push_back(row);
    }
  }

  void silhouettes() {
    if (!embree_) return;
    for (const BuiltPair& pair : pairs_) {
      const EsvoFile contours(pair.contours->file), cubes(pair.cubes->file);
      double rays_count = 0, of_cubes = 0, of_contours = 0;
      for (const View& view : views_) {
        step("silhouettes of " + scene_.name);
        const PrimaryRays rays(contours.view(), contours.grid(), view, {1024, 768}, 0);
        std::vector<TraceRunner> runners =
            embree_->prepare(contours.grid(), {RayClass::kPrimary, rays.plain});
        runners.resize(1);
        runners.push_back(esvo_runner<EsvoNodes>(cubes.view(), rays.plain));
        runners.push_back(esvo_runner<ContourNodes>(contours.view(), rays.plain));
        const std::vector<Measured> found = measure(runners, rays.plain.size(), 0);
        const auto count = static_cast<double>(rays.plain.size());
        rays_count += count;
        of_cubes += count - static_cast<double>(agreeing(found[0].hits, found[1].hits));
        of_contours += count - static_cast<double>(agreeing(found[0].hits, found[2].hits));
      }
      if (rays_count > 0)
        results_.silhouettes.push_back(
            {scene_.name, pair.levels, of_cubes / rays_count, of_contours / rays_count});
    }
  }

 private:
  /// Adds the rays of a view and returns their number. All octrees get equal rays, except for the
  /// starts from beams.
  std::size_t add_view(const Octrees& octrees, const View& view, ImageSize size,
                       std::array<FormSums, kEsvoForms.size()>& sums) {
    const auto& [contours, cubes, coarse] = octrees;
    PrimaryRays rays(contours.view(), contours.grid(), view, size, plan_.lod_pixels);
    std::optional<PrimaryRays> coarse_rays;
    if (coarse) coarse_rays.emplace(coarse->view(), coarse->grid(), view, size, plan_.lod_pixels);
    std::vector<TraceRunner> runners;
    std::vector<std::size_t> forms;
    const auto add = [&](TraceRunner runner, std::size_t form) {
      runners.push_back(std::move(runner));
      forms.push_back(form);
    };
    if (embree_)
      for (TraceRunner& runner :
           embree_->prepare(contours.grid(), {RayClass::kPrimary, rays.plain}))
        add(std::move(runner), kTriangles);
    add(esvo_runner<EsvoNodes>(cubes.view(), rays.plain), kCubes);
    add(esvo_runner<ContourNodes>(contours.view(), rays.plain), kContours);
    const auto add_with_beams = [&](const EsvoFile& file, PrimaryRays& own, std::size_t form) {
      TraceRunner runner = esvo_runner<ContourNodes>(file.view(), own.with_beams);
      runner.before = [&own] { own.beams.run(); };
      add(std::move(runner), form);
    };
    add_with_beams(contours, rays, kContoursBeams);
    if (coarse) {
      add(esvo_runner<ContourNodes>(coarse->view(), coarse_rays->plain), kCoarseContours);
      add_with_beams(*coarse, *coarse_rays, kCoarseContoursBeams);
    }

    const std::vector<Measured> measured = measure(runners, rays.plain.size(), plan_.repeat);
    std::array<FormSums, kEsvoForms.size()> best;
    best.fill({HUGE_VAL, 0});
    for (std::size_t i = 0; i < measured.size(); ++i)
      if (measured[i].seconds < best[forms[i]].seconds)
        best[forms[i]] = {measured[i].seconds,
                          static_cast<double>(agreeing(measured[0].hits, measured[i].hits))};
    for (std::size_t form = 0; form < best.size(); ++form) {
      sums[form].seconds += best[form].seconds;
      sums[form].agreeing += best[form].agreeing;
    }
    return rays.plain.size();
  }

  void step(const std::string& stage) {
    progress_.throw_if_cancelled();
    progress_.report(stage, 0);
  }

  const EsvoBenchPlan& plan_;
  const EsvoBenchScene& scene_;
  Progress& progress_;
  EsvoBenchResults& results_;
  std::vector<BuiltPair> pairs_;
  std::optional<EmbreeRival> embree_;
  std::vector<View> views_;
};

}  // namespace

void bench_esvo_rays(const EsvoBenchPlan& plan, const EsvoBenchScene& scene,
                     const std::filesystem::path& mesh, Progress& progress,
                     EsvoBenchResults& results) {
  SceneRays rays(plan, scene, mesh, progress, results);
  if (plan.silhouettes) rays.silhouettes();
  rays.rates();
}

}  // namespace voxdag
