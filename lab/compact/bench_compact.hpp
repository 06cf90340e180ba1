#pragma once
/// `voxdag bench compact`: bytes of DAGs in the compact forms of several papers.
#include <filesystem>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "lab/compact/compact_forms.hpp"
#include "lab/runs/scene_runs.hpp"
#include "voxdag/formats/readers/read_options.hpp"

namespace voxdag::lab {

struct CompactPlan {
  /// Mesh files, procedural scenes as NAME or NAME:SIZE, and .vdag files of DAGs.
  std::vector<std::string> scenes;
  std::vector<int> levels;                ///< Of the grids of meshes; ascending.
  std::vector<const CompactForm*> forms;  ///< In the order of compact_forms().
  ReadOptions read;                       ///< Rights of the readers; its other members are unused.
};

/// A DAG in one form.
struct FormResult {
  const CompactForm* form = nullptr;
  SizeInParts size;
  double seconds = 0;  ///< Wall-clock seconds of the encoder, from the DAG in memory.
};

/// The DAG of a scene at one resolution.
struct CompactRun : SceneRun {
  std::uint64_t svo_nodes = 0, dag_nodes = 0;
  /// NaN: the DAG was read from a file.
  double build_seconds = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t reference_bytes = 0;  ///< In kReferenceForm.
  std::vector<FormResult> forms;

  double part_of_reference(const FormResult& result) const;
  double bits_per_voxel(const FormResult& result) const {
    return SceneRun::bits_per_voxel(result.size.bytes());
  }
};

struct CompactResults {
  std::vector<CompactRun> runs;
};

/// Geometric means over all runs without a failure.
struct FormMeans {
  const CompactForm* form = nullptr;
  std::size_t runs = 0;
  double part_of_reference = 0, bits_per_voxel = 0;
};
std::vector<FormMeans> form_means(const CompactResults& results);

/// Builds or opens each scene and measures all forms. A scene that fails is a run with a failure.
/// Throws Cancelled.
CompactResults bench_compact(const CompactPlan& plan, Progress& progress);

nlohmann::ordered_json compact_json(const CompactResults& results,
                                    const nlohmann::ordered_json& machine);

}  // namespace voxdag::lab
