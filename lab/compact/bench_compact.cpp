#include "lab/compact/bench_compact.hpp"

#include <fmt/core.h>

#include <cmath>

#include "lab/build/bench_mesh.hpp"
#include "lab/compact/plain_sizes.hpp"
#include "lab/report/scratch_folder.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/dag/stop_watch.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/io/process_memory.hpp"
#include "voxdag/file/model/scene_model.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"

namespace voxdag::lab {
namespace {

namespace fs = std::filesystem;

/// Returns the name of the mesh, or of the file if that is unknown.
std::string name_of(const SceneMetadata& metadata, const std::string& path) {
  const std::string& source = metadata.source.name;
  return source.empty() ? fs::path(path).filename().string() : source;
}

class Bench {
 public:
  Bench(const CompactPlan& plan, Progress& progress) : plan_(plan), progress_(progress) {}

  CompactResults run() {
    measure_scenes(plan_.scenes, results_.runs, [this](const std::string& scene) {
      if (fs::path(scene).extension() == ".vdag")
        measure_file(scene);
      else
        measure_mesh(scene);
    });
    return std::move(results_);
  }

 private:
  CompactRun& add_run(const std::string& scene, int levels) {
    CompactRun& run = results_.runs.emplace_back();
    run.scene = scene;
    run.levels = levels;
    return run;
  }

  void measure_file(const std::string& path) {
    const SceneModel file(path, &progress_);
    const VoxelSet voxels = file.voxels();
    if (voxels.dag() == nullptr) throw Error(path, "", "is not a DAG");
    measure(*voxels.dag(), add_run(name_of(file.metadata(), path), voxels.levels()));
  }

  void measure_mesh(const std::string& scene) {
    const PreparedMesh prepared = prepare_mesh(scene, folder_.path(), progress_);
    MemoryBudget memory = command_budget(0);
    ReadOptions read = plan_.read;
    read.work = {&memory, &progress_};
    const Mesh mesh = read_mesh(prepared.path, read);
    for (const int levels : plan_.levels) {
      CompactRun& run = add_run(prepared.identity.name, levels);
      StopWatch watch;
      const BuildResult built =
          build_svdag(mesh, fit_grid(mesh, levels), {}, {&memory, &progress_});
      run.build_seconds = watch.lap();
      measure(built.dag.view(), run);
    }
  }

  void measure(const SvdagView& dag, CompactRun& run) {
    const SvdagCounts counts = count_svdag(dag);
    run.voxels = counts.voxels;
    run.svo_nodes = counts.svo_nodes();
    run.dag_nodes = counts.dag_nodes();
    run.reference_bytes = svdag_size(dag).bytes();
    if (run.voxels == 0) throw Error(run.scene, std::to_string(1 << run.levels), "has no voxels");
    for (const CompactForm* form : plan_.forms) {
      progress_.report(fmt::format("encoding {} {} as {}", run.scene, 1 << run.levels, form->title),
                       0);
      StopWatch watch;
      FormResult result{form, form->measure(dag, progress_), 0};
      result.seconds = watch.lap();
      run.forms.push_back(std::move(result));
    }
  }

  const CompactPlan& plan_;
  Progress& progress_;
  ScratchFolder folder_;
  CompactResults results_;
};

}  // namespace

double CompactRun::part_of_reference(const FormResult& result) const {
  return static_cast<double>(result.size.bytes()) / static_cast<double>(reference_bytes);
}

std::vector<FormMeans> form_means(const CompactResults& results) {
  std::vector<FormMeans> means;
  for (const CompactForm& form : compact_forms()) {
    FormMeans mean{&form};
    for (const CompactRun& run : results.runs) {
      if (!run.failure.empty()) continue;
      for (const FormResult& result : run.forms) {
        if (result.form != &form) continue;
        ++mean.runs;
        mean.part_of_reference += std::log(run.part_of_reference(result));
        mean.bits_per_voxel += std::log(run.bits_per_voxel(result));
      }
    }
    if (mean.runs == 0) continue;
    mean.part_of_reference = std::exp(mean.part_of_reference / static_cast<double>(mean.runs));
    mean.bits_per_voxel = std::exp(mean.bits_per_voxel / static_cast<double>(mean.runs));
    means.push_back(mean);
  }
  return means;
}

CompactResults bench_compact(const CompactPlan& plan, Progress& progress) {
  return Bench(plan, progress).run();
}

}  // namespace voxdag::lab
