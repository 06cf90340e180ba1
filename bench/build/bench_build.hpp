#pragma once
/// What `voxdag bench build` measures: builds, and other programs beside them. Every run is a
/// process of its own, so that time and peak memory are those of the run.
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "bench/report/bench_child.hpp"

namespace voxdag {

/// Another program that does comparable work.
struct Rival {
  std::string name;
  /// For the shell. {mesh} and {out} stand for quoted paths ({out} in an empty folder, which is the
  /// working directory, and is removed afterwards), {resolution} and {levels} for the grid.
  std::string command;
};

struct BenchPlan {
  std::vector<std::string> meshes;  ///< Paths, or procedural scenes as NAME or NAME:SIZE.
  std::vector<int> levels;
  std::vector<std::string> methods;  ///< As `build --method` names them.
  std::vector<Rival> rivals;
  int threads = 0;              ///< 0: one for each processor.
  int repeat = 1;               ///< The fastest of so many runs counts.
  double rival_seconds = 3600;  ///< A rival that takes longer is ended.
};

/// One build, read from disk cache to written file.
struct BuildRun {
  std::string scene, method;
  int levels = 0;
  int threads = 0;
  double load_before = 0;  ///< Load average when the run began.
  std::string failure;     ///< Why there are no figures, or empty.
  ProcessCost cost;
  std::vector<std::pair<std::string, double>> stage_seconds;  ///< `seconds` of `build --json`.
  std::uint64_t triangles = 0, vertices = 0;
  std::uint64_t voxels = 0, svo_nodes = 0, dag_nodes = 0;
  std::uint64_t dag_bytes = 0, file_bytes = 0;

  std::uint64_t mesh_bytes() const { return 12 * (triangles + vertices); }
  /// What the peak memory is measured against.
  std::uint64_t memory_allowance() const {
    return 3 * dag_bytes + mesh_bytes() + (std::uint64_t{256} << 20);
  }
  double memory_ratio() const {
    return static_cast<double>(cost.peak_bytes) / static_cast<double>(memory_allowance());
  }
  double voxels_per_second() const { return static_cast<double>(voxels) / cost.wall_seconds; }
  /// 0 for a stage that the method does not have.
  double stage(const std::string& name) const {
    for (const auto& [stage, seconds] : stage_seconds)
      if (stage == name) return seconds;
    return 0;
  }
};

struct RivalRun {
  std::string name, command, scene;
  int levels = 0;
  double load_before = 0;
  std::string failure;
  ProcessCost cost;
  std::uint64_t output_bytes = 0;  ///< Of all files that it left in its folder.
  std::string reported;            ///< The last line of its output where that is a JSON object.
};

struct BenchResults {
  std::vector<BuildRun> builds;  ///< By scene, then method, then levels.
  std::vector<RivalRun> rivals;
};

/// Runs the plan. Each mesh is read once beforehand, so that none pays for the disk. A run that
/// fails is recorded, and greater resolutions of the same are left out. Throws Error where a mesh
/// cannot be read or made, and Cancelled.
BenchResults bench_build(const BenchPlan& plan, Progress& progress);

}  // namespace voxdag
