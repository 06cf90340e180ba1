#pragma once
/// The measurements behind the tables of the ESVO paper.
#include <nlohmann/json.hpp>
#include <vector>

#include "lab/esvo/bench_esvo.hpp"
#include "lab/reproduce/build_series.hpp"
#include "lab/reproduce/run_items.hpp"

namespace voxdag::lab {

/// The runs for one scene of the ESVO paper; none if the scene is absent.
struct EsvoSceneRuns {
  FoundScene scene;
  std::vector<SeriesRun> builds;  ///< For Table 1: with contours, colours and normals.
  std::vector<SeriesRun> rays;    ///< For Table 2: `voxdag bench esvo` at each resolution.
};

/// Measures what the tables need. Throws Error and Cancelled.
EsvoSceneRuns measure_esvo_scene(const PapersPlan& plan, const FoundScene& scene, CellStore& cells,
                                 const Progress& progress);

/// Returns the series of measure_esvo_scene() as items, the longest first.
std::vector<RunItem> esvo_run_items(const PapersPlan& plan, const FoundScene& scene,
                                    CellStore& cells, const Progress& progress);

/// Returns the octree's size in units of 2^20 bytes.
double esvo_megabytes(const CellResult& build);
double bytes_per_voxel(const CellResult& build);

/// Returns the measurements of a run for pictures of this size, or null.
const nlohmann::ordered_json* rays_of_size(const CellResult& run, ImageSize size);
/// Returns million rays per second; NaN if the form was not measured.
double esvo_rate(const CellResult& run, ImageSize size, EsvoForm form);
/// Returns the CPU's rate of a run, also if the run's rates are those of a CUDA device.
double esvo_rate_on_cpu(const CellResult& run, ImageSize size, EsvoForm form);
/// Returns the seconds of the filter alone; NaN if they were not measured.
double filter_seconds(const nlohmann::ordered_json& row);

/// Returns the silhouettes of all resolutions of a scene.
std::vector<SilhouetteRow> silhouettes_of(const EsvoSceneRuns& runs);

nlohmann::ordered_json esvo_runs_json(const std::vector<EsvoSceneRuns>& scenes);

}  // namespace voxdag::lab
