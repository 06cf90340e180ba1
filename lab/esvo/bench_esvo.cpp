#include "lab/esvo/bench_esvo.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "lab/build/bench_mesh.hpp"
#include "lab/report/bench_machine.hpp"
#include "lab/report/scratch_folder.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag::lab {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

class Bench {
 public:
  Bench(const EsvoBenchPlan& plan, Progress& progress) : plan_(plan), progress_(progress) {
    results_.threads =
        plan.threads > 0 ? plan.threads : static_cast<int>(std::thread::hardware_concurrency());
  }

  /// Runs all builds first, because a child's peak memory includes the size of this program at the
  /// fork.
  EsvoBenchResults run() {
    std::vector<fs::path> meshes;
    for (const EsvoBenchScene& scene : plan_.scenes) {
      PreparedMesh mesh = prepare_mesh(scene.mesh, folder_.path(), progress_);
      mesh.identity.is_displaced = !scene.is_plain();
      build_all(scene, mesh);
      meshes.push_back(mesh.path);
    }
    // Not before the builds, because the device's driver would count as memory of this program.
    if (!can_cast()) return std::move(results_);
    for (std::size_t i = 0; i < plan_.scenes.size(); ++i)
      bench_esvo_rays(plan_, plan_.scenes[i], meshes[i], progress_, results_);
    return std::move(results_);
  }

 private:
  /// Returns whether the device that was asked for is there.
  bool can_cast() {
    if (plan_.device.kind != DeviceChoice::Kind::kCuda) return true;
    try {
      choose_cuda_device(plan_.device.index);
    } catch (const Error& error) {
      results_.device_failure = error.what();
    }
    return results_.device_failure.empty();
  }

  void build_all(const EsvoBenchScene& scene, const PreparedMesh& mesh) {
    for (const int levels : plan_.levels)
      for (const bool with_contours : {true, false}) {
        progress_.report(fmt::format("building {} {}", scene.name, 1 << levels),
                         static_cast<double>(steps_++) /
                             static_cast<double>(2 * plan_.levels.size() * plan_.scenes.size()));
        results_.builds.push_back(build(scene, mesh, levels, with_contours));
        if (!results_.builds.back().failure.empty()) return;
      }
  }

  EsvoBuildRun build(const EsvoBenchScene& scene, const PreparedMesh& mesh, int levels,
                     bool with_contours) {
    EsvoBuildRun run;
    run.scene = scene.name;
    run.paper = match_paper_scene(Paper::kEsvo, mesh.identity);
    run.levels = levels;
    run.with_contours = with_contours;
    run.load_before = load_average();
    run.file = folder_.path() / fmt::format("{}.esvo", steps_);
    std::vector<std::string> command{voxdag_program(),
                                     "build",
                                     mesh.path,
                                     "-r",
                                     std::to_string(1 << levels),
                                     "--as",
                                     "esvo",
                                     "-o",
                                     run.file,
                                     "--json",
                                     "--threads",
                                     std::to_string(results_.threads)};
    if (!with_contours) command.emplace_back("--no-contours");
    command.insert(command.end(), scene.options.begin(), scene.options.end());
    const ChildResult child = run_child(command, fs::current_path(), 0, progress_);
    run.cost = child.cost;
    run.failure = failure_of(child, 0);
    if (!run.failure.empty()) return run;
    const Json json = Json::parse(child.out);
    const Json& seconds = json.at("seconds");
    run.build_seconds = seconds.at("build");
    run.read_seconds = seconds.at("total").get<double>() - run.build_seconds;
    run.voxels = json.at("voxels");
    run.bytes = json.at("bytes").at("esvo");
    run.contours = json.at("contours");
    run.far_pointers = json.at("far_pointers");
    return run;
  }

  const EsvoBenchPlan& plan_;
  Progress& progress_;
  ScratchFolder folder_;
  EsvoBenchResults results_;
  std::size_t steps_ = 0;
};

}  // namespace

bool EsvoBenchScene::is_plain() const {
  return std::none_of(options.begin(), options.end(),
                      [](const std::string& option) { return option.starts_with("--displace"); });
}

EsvoBenchScene parse_esvo_scene(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos)
    throw std::invalid_argument("must be NAME=MESH, then options of build");
  EsvoBenchScene scene;
  scene.name = text.substr(0, equals);
  const std::size_t options = std::min(text.find(" --", equals), text.size());
  scene.mesh = text.substr(equals + 1, options - equals - 1);
  if (scene.mesh.empty()) throw std::invalid_argument("has no mesh after the '='");
  std::istringstream words(text.substr(options));
  for (std::string word; words >> word;) scene.options.push_back(word);
  return scene;
}

EsvoBenchResults bench_esvo(const EsvoBenchPlan& plan, Progress& progress) {
  return Bench(plan, progress).run();
}

}  // namespace voxdag::lab
