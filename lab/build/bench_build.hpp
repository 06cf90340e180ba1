#pragma once
/// `voxdag bench build`: time and memory of builds, also of other programs. Every run is a separate
/// process, so that its time and peak memory can be measured.
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "lab/papers/paper_scenes.hpp"
#include "lab/report/bench_child.hpp"
#include "lab/rivals/rival.hpp"

namespace voxdag::lab {

struct BenchPlan {
  std::vector<std::string> meshes;  ///< Paths, or procedural scenes as NAME or NAME:SIZE.
  std::vector<int> levels;
  std::vector<std::string> methods;        ///< As `build --method` names them.
  std::vector<std::string> build_options;  ///< Passed to `build` as they are.
  std::vector<std::shared_ptr<Rival>> rivals;
  int threads = 0;              ///< 0: one per processor.
  int repeat = 1;               ///< Number of runs; the fastest counts.
  double rival_seconds = 3600;  ///< Time limit for a rival.
};

/// One build, from the mesh in the disk cache to the written file.
struct BuildRun {
  std::string scene, method;
  PaperMatch paper;  ///< The scene of the SVDAG paper that this one stands for.
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
  /// Returns the peak memory that counts as acceptable, in bytes.
  std::uint64_t memory_allowance() const {
    return 3 * dag_bytes + mesh_bytes() + (std::uint64_t{256} << 20);
  }
  double memory_ratio() const {
    return static_cast<double>(cost.peak_bytes) / static_cast<double>(memory_allowance());
  }
  double voxels_per_second() const { return static_cast<double>(voxels) / cost.wall_seconds; }
  /// Returns the seconds of a stage; 0 if the method does not have this stage.
  double stage(const std::string& name) const {
    for (const auto& [stage, seconds] : stage_seconds)
      if (stage == name) return seconds;
    return 0;
  }
};

struct RivalRun {
  std::string name, scene;
  int levels = 0;
  double load_before = 0;  ///< Load average when the run began.
  RivalBuild build;
};

struct BenchResults {
  std::vector<BuildRun> builds;  ///< By scene, then method, then levels.
  std::vector<RivalRun> rivals;
};

/// Runs the plan. Reads each mesh once beforehand, so that no run waits for the disk. Records a run
/// that fails, and skips higher resolutions of its series. Throws Error if a mesh cannot be read or
/// generated, and Cancelled.
BenchResults bench_build(const BenchPlan& plan, Progress& progress);

}  // namespace voxdag::lab
