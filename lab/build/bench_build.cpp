#include "lab/build/bench_build.hpp"

#include <fmt/core.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "lab/build/bench_mesh.hpp"
#include "lab/report/bench_machine.hpp"
#include "lab/report/scratch_folder.hpp"

namespace voxdag::lab {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

class Bench {
 public:
  Bench(const BenchPlan& plan, Progress& progress) : plan_(plan), progress_(progress) {}

  BenchResults run() {
    for (const std::string& mesh : plan_.meshes) {
      const PreparedMesh prepared = prepare_mesh(mesh, folder_.path(), progress_);
      const std::string scene = is_procedural(mesh) ? mesh : fs::path(mesh).filename().string();
      for (const std::string& method : plan_.methods) run_builds(scene, prepared, method);
      for (const auto& rival : plan_.rivals) run_rival(scene, prepared.path, *rival);
    }
    return std::move(results_);
  }

 private:
  void run_builds(const std::string& scene, const PreparedMesh& mesh, const std::string& method) {
    for (const int levels : plan_.levels) {
      step(fmt::format("{} {}", scene, 1 << levels));
      results_.builds.push_back(fastest_build(scene, mesh, method, levels));
      if (!results_.builds.back().failure.empty()) return;
    }
  }

  BuildRun fastest_build(const std::string& scene, const PreparedMesh& mesh,
                         const std::string& method, int levels) {
    BuildRun fastest;
    for (int i = 0; i < plan_.repeat; ++i) {
      BuildRun run = build(scene, mesh, method, levels);
      if (!run.failure.empty()) return run;
      if (i == 0 || run.cost.wall_seconds < fastest.cost.wall_seconds) fastest = std::move(run);
    }
    return fastest;
  }

  BuildRun build(const std::string& scene, const PreparedMesh& mesh, const std::string& method,
                 int levels) {
    BuildRun run;
    run.scene = scene;
    run.method = method;
    run.levels = levels;
    run.threads =
        plan_.threads > 0 ? plan_.threads : static_cast<int>(std::thread::hardware_concurrency());
    run.load_before = load_average();
    const ScratchFolder folder;
    std::vector<std::string> command{voxdag_program(),
                                     "build",
                                     mesh.path,
                                     "-r",
                                     std::to_string(1 << levels),
                                     "-o",
                                     "out.vdag",
                                     "--json",
                                     "--method",
                                     method,
                                     "--threads",
                                     std::to_string(run.threads)};
    command.insert(command.end(), plan_.build_options.begin(), plan_.build_options.end());
    const ChildResult child = run_child(command, folder.path(), 0, progress_);
    run.cost = child.cost;
    run.failure = failure_of(child, 0);
    if (!run.failure.empty()) return run;
    const Json json = Json::parse(child.out);
    for (const auto& [stage, seconds] : json.at("seconds").items())
      run.stage_seconds.emplace_back(stage, seconds);
    run.triangles = json.at("source").at("triangles");
    run.vertices = json.at("source").at("vertices");
    MeshIdentity identity = mesh.identity;
    identity.triangles = run.triangles;
    run.paper = match_paper_scene(Paper::kSvdag, identity);
    run.voxels = json.at("voxels");
    run.svo_nodes = json.at("svo_nodes");
    run.dag_nodes = json.at("dag_nodes");
    run.dag_bytes = json.at("bytes").at("svdag_paper");
    run.file_bytes = json.at("bytes").at("file");
    return run;
  }

  void run_rival(const std::string& scene, const fs::path& path, Rival& rival) {
    for (const int levels : plan_.levels) {
      step(fmt::format("{}: {} {}", rival.name(), scene, 1 << levels));
      const double load = load_average();
      std::optional<RivalBuild> build = rival.build({path, levels, plan_.rival_seconds}, progress_);
      if (!build) return;
      results_.rivals.push_back({rival.name(), scene, levels, load, std::move(*build)});
      if (!results_.rivals.back().build.failure.empty()) return;
    }
  }

  void step(const std::string& stage) {
    const std::size_t of =
        plan_.meshes.size() * plan_.levels.size() * (plan_.methods.size() + plan_.rivals.size());
    progress_.report(stage, static_cast<double>(steps_++) / static_cast<double>(of));
  }

  const BenchPlan& plan_;
  Progress& progress_;
  ScratchFolder folder_;
  BenchResults results_;
  std::size_t steps_ = 0;
};

}  // namespace

BenchResults bench_build(const BenchPlan& plan, Progress& progress) {
  return Bench(plan, progress).run();
}

}  // namespace voxdag::lab
