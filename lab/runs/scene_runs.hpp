#pragma once
/// Runs of a benchmark that measures scenes at several resolutions.
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lab/runs/machine.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag::lab {

/// A scene at one resolution.
struct SceneRun {
  std::string scene;
  int levels = 0;            ///< 0: the scene failed before its grid was known.
  std::uint64_t voxels = 0;  ///< Not known if the run failed.
  std::string failure;       ///< Empty: the run was measured.

  double bits_per_voxel(std::uint64_t bytes) const {
    return 8 * static_cast<double>(bytes) / static_cast<double>(voxels);
  }
};

/// Calls measure(scene) for each scene, which appends to `runs`. If it throws Error, the last run
/// of this scene gets the failure; a scene without runs gets one. Throws Cancelled.
template <class Run, class Measure>
void measure_scenes(const std::vector<std::string>& scenes, std::vector<Run>& runs,
                    const Measure& measure) {
  for (const std::string& scene : scenes) {
    const std::size_t before = runs.size();
    try {
      measure(scene);
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& error) {
      if (runs.size() == before)
        runs.emplace_back().scene = std::filesystem::path(scene).filename().string();
      runs.back().failure = error.what();
    }
  }
}

/// Throws the first failure of the runs as Error.
template <class Run>
void throw_failure(const std::vector<Run>& runs) {
  for (const Run& run : runs)
    if (!run.failure.empty()) throw Error(run.failure);
}

/// Returns program, machine and runs as JSON. A run has its scene, its resolution and its failure,
/// or what fill(json, run) adds.
template <class Run, class Fill>
nlohmann::ordered_json scene_runs_json(const std::vector<Run>& runs,
                                       const nlohmann::ordered_json& machine, const Fill& fill) {
  nlohmann::ordered_json json{{"program", program_name()}, {"machine", machine}};
  json["runs"] = nlohmann::ordered_json::array();
  for (const Run& run : runs) {
    nlohmann::ordered_json& of = json["runs"].emplace_back();
    of = {{"scene", run.scene}, {"resolution", std::int64_t{1} << run.levels}};
    if (run.failure.empty())
      fill(of, run);
    else
      of["failure"] = run.failure;
  }
  return json;
}

}  // namespace voxdag::lab
