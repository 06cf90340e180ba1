/// Writes the results of `voxdag bench attributes` as JSON.
#include <cmath>
#include <nlohmann/json.hpp>

#include "lab/attributes/bench_attributes.hpp"

namespace voxdag::lab {
namespace {

using Json = nlohmann::ordered_json;

/// Returns the number, or null if it is not finite.
Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

double cells_per_second(const AttributesRun& run, double seconds) {
  return static_cast<double>(run.cells) / seconds;
}

Json result_json(const AttributesRun& run, const ColorResult& result) {
  return {{"codec", key_of(result.codec)},
          {"bound", finite_or_null(result.bound)},
          {"bytes", result.bytes},
          {"wire_bytes", result.wire_bytes > 0 ? Json(result.wire_bytes) : Json()},
          {"bits_per_cell", run.bits_per_cell(result)},
          {"bits_per_voxel", run.bits_per_voxel(result.bytes)},
          {"psnr_db", finite_or_null(result.psnr_db)},
          {"ms_ssim", result.ms_ssim},
          {"mean_ms_ssim", result.mean_ms_ssim()},
          {"seconds", result.seconds},
          {"cells_per_second", cells_per_second(run, result.seconds)}};
}

void add_figures(Json& json, const AttributesRun& run) {
  json["voxels"] = run.voxels;
  json["cells"] = run.cells;
  json["index_bytes"] = run.index_bytes;
  json["filter_seconds"] = run.filter_seconds;
  json["filter_cells_per_second"] = cells_per_second(run, run.filter_seconds);
  json["results"] = Json::array();
  for (const ColorResult& result : run.results) json["results"].push_back(result_json(run, result));
}

}  // namespace

Json attributes_json(const AttributesResults& results, const Json& machine) {
  return scene_runs_json(results.runs, machine, add_figures);
}

}  // namespace voxdag::lab
