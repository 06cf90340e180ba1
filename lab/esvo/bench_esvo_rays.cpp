/// Measures the rays of `voxdag bench esvo`: Table 2, and silhouettes against the mesh.
#include <tbb/task_arena.h>

#include <cmath>
#include <map>
#include <memory>
#include <optional>

#include "lab/esvo/bench_esvo.hpp"
#include "lab/rays/caster_runner.hpp"
#include "lab/rays/cuda_runner.hpp"
#include "lab/rays/trace_measure.hpp"
#include "lab/rays/trace_rays.hpp"
#include "lab/rivals/embree_rival.hpp"
#include "voxdag/cpu/packets/packet_caster.hpp"
#include "voxdag/file/esvo_file.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"

namespace voxdag::lab {
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

/// An octree, also in the memory of the plan's CUDA device if it casts there.
struct Octree {
  Octree(const EsvoBuildRun& run, const DeviceChoice& device, DeviceLayout layout)
      : file(run.file), on_device(load_on_device(device, file.view(), layout)) {}

  EsvoFile file;
  std::optional<DeviceScene> on_device;
};

/// The targets of the rays, all in the same cube.
struct Octrees {
  Octree contours, cubes;
  std::optional<Octree> coarse;  ///< Contours whose silhouettes are as good as the cubes'.

  /// Casts on the CPU unless all octrees fit into the memory of the device.
  void use_one_device() {
    if (contours.on_device && cubes.on_device && (!coarse || coarse->on_device)) return;
    contours.on_device.reset();
    cubes.on_device.reset();
    if (coarse) coarse->on_device.reset();
  }
};

/// The sums over views of a form's casts.
struct FormSums {
  double seconds = 0, agreeing = 0;          ///< `agreeing`: with the triangles.
  double cpu_seconds = 0, cpu_agreeing = 0;  ///< Only if `seconds` are a CUDA device's.

  void operator+=(const FormSums& more) {
    seconds += more.seconds;
    agreeing += more.agreeing;
    cpu_seconds += more.cpu_seconds;
    cpu_agreeing += more.cpu_agreeing;
  }
};
using AllSums = std::array<FormSums, kEsvoForms.size()>;

/// The casts of all forms at the rays of a view.
class ViewCasts {
 public:
  void add(TraceRunner runner, std::size_t form) { add(std::move(runner), form, false); }

  /// Adds casts of `rays`, which must outlive this object, at an octree: on its CUDA device and on
  /// the CPU, or only on the CPU.
  template <class Nodes>
  void add(const Octree& octree, PrimaryRays& rays, std::size_t form, bool with_beams) {
    std::optional<TimedBeams> beams;
    if (octree.on_device && with_beams) {
      beams.emplace(*octree.on_device, rays.beams.setup());
      // The beams of the CPU and of the device differ.
      rays.with_beams = primary_rays(rays.beams.setup(), beams->starts().data());
    }
    const std::vector<CastRay>& set = with_beams ? rays.with_beams : rays.plain;
    TraceRunner on_cpu = esvo_runner<Nodes>(octree.file.view(), set);
    if (with_beams) on_cpu.before = [&rays] { rays.beams.run(); };
    if (octree.on_device)
      add(cuda_runner(*octree.on_device, RayClass::kPrimary, set, beams), form, false);
    add(std::move(on_cpu), form, octree.on_device.has_value());
  }

  /// Measures all casts of `count` rays each. Agreement is with the first cast that was added.
  AllSums measure(std::size_t count, int repeat) const {
    const std::vector<Measured> measured = lab::measure(runners_, count, repeat);
    AllSums best;
    best.fill({HUGE_VAL, 0, 0, 0});
    for (std::size_t i = 0; i < measured.size(); ++i) {
      FormSums& sums = best[casts_[i].form];
      if (casts_[i].is_check) {  // of the cast before it
        sums.cpu_seconds = measured[i].seconds;
        sums.cpu_agreeing = static_cast<double>(agreeing(measured[i - 1].hits, measured[i].hits));
      } else if (measured[i].seconds < sums.seconds) {
        sums.seconds = measured[i].seconds;
        sums.agreeing = static_cast<double>(agreeing(measured[0].hits, measured[i].hits));
      }
    }
    return best;
  }

 private:
  struct Cast {
    std::size_t form;
    bool is_check;  ///< On the CPU, only to check the cast before it, which is on CUDA.
  };

  void add(TraceRunner runner, std::size_t form, bool is_check) {
    runners_.push_back(std::move(runner));
    casts_.push_back({form, is_check});
  }

  std::vector<TraceRunner> runners_;
  std::vector<Cast> casts_;
};

class SceneRays {
 public:
  SceneRays(const EsvoBenchPlan& plan, const EsvoBenchScene& scene,
            const std::filesystem::path& mesh_file, Progress& progress, EsvoBenchResults& results)
      : plan_(plan), scene_(scene), progress_(progress), results_(results) {
    pairs_ = pairs_of(results, scene.name);
    if (pairs_.empty()) return;
    if (scene.is_plain() && EmbreeRival::is_available())
      embree_.emplace(read_mesh(mesh_file, {&progress}));
    const EsvoFile finest(pairs_.back().contours->file);
    views_ = bench_views(finest.view(), finest.grid(), 4.0 / 3, plan.views);
  }

  /// Measures the rays of all forms. Chooses the coarse grid by the measured silhouettes.
  void rates() {
    if (pairs_.empty()) return;
    const BuiltPair& pair = pairs_.back();
    Octrees octrees{Octree(*pair.contours, plan_.device, DeviceLayout::kContours),
                    Octree(*pair.cubes, plan_.device, DeviceLayout::kCubes),
                    {}};
    const int coarse_at = coarse_levels(results_.silhouettes, scene_.name);
    for (const BuiltPair& other : pairs_)
      if (other.levels == coarse_at)
        octrees.coarse.emplace(*other.contours, plan_.device, DeviceLayout::kContours);
    octrees.use_one_device();
    const std::optional<DeviceScene>& on_device = octrees.contours.on_device;
    if (on_device) results_.cuda_device = on_device->device().name;
    for (const ImageSize size : plan_.sizes) {
      EsvoRateRow row;
      row.scene = scene_.name;
      row.paper = pair.contours->paper;
      row.levels = pair.levels;
      row.size = size;
      row.on_cuda = on_device.has_value();
      AllSums sums;
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
        const bool is_checked = row.on_cuda && is_measured && form != kTriangles;
        row.cpu_mrays_per_second[form] = is_checked ? count / sums[form].cpu_seconds * 1e-6 : NAN;
        row.agreement_with_cpu[form] = is_checked ? sums[form].cpu_agreeing / count : NAN;
      }
      if (row.rays == 0) continue;
      step("pictures of " + scene_.name);
      row.seconds = picture_cost(octrees.contours.file, on_device ? &*on_device : nullptr, views_,
                                 size, plan_.lod_pixels, plan_.repeat);
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
  std::size_t add_view(const Octrees& octrees, const View& view, ImageSize size, AllSums& sums) {
    const auto& [contours, cubes, coarse] = octrees;
    PrimaryRays rays(contours.file.view(), contours.file.grid(), view, size, plan_.lod_pixels);
    std::optional<PrimaryRays> coarse_rays;
    if (coarse)
      coarse_rays.emplace(coarse->file.view(), coarse->file.grid(), view, size, plan_.lod_pixels);
    ViewCasts casts;
    if (embree_)
      for (TraceRunner& runner :
           embree_->prepare(contours.file.grid(), {RayClass::kPrimary, rays.plain}))
        casts.add(std::move(runner), kTriangles);
    casts.add<EsvoNodes>(cubes, rays, kCubes, false);
    casts.add<ContourNodes>(contours, rays, kContours, false);
    casts.add<ContourNodes>(contours, rays, kContoursBeams, true);
    if (coarse) {
      casts.add<ContourNodes>(*coarse, *coarse_rays, kCoarseContours, false);
      casts.add<ContourNodes>(*coarse, *coarse_rays, kCoarseContoursBeams, true);
    }
    const AllSums of_view = casts.measure(rays.plain.size(), plan_.repeat);
    for (std::size_t form = 0; form < sums.size(); ++form) sums[form] += of_view[form];
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

}  // namespace voxdag::lab
