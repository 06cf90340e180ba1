/// Writes the results of `voxdag bench compact` as JSON.
#include <cmath>
#include <nlohmann/json.hpp>

#include "lab/compact/bench_compact.hpp"

namespace voxdag::lab {
namespace {

using Json = nlohmann::ordered_json;

Json form_json(const CompactRun& run, const FormResult& result) {
  Json json{{"bytes", result.size.bytes()},
            {"of_svdag", run.part_of_reference(result)},
            {"bits_per_voxel", run.bits_per_voxel(result)},
            {"seconds", result.seconds}};
  json["parts"] = Json::object();
  for (const SizePart& part : result.size.parts) json["parts"][part.name] = part.bytes;
  return json;
}

void add_figures(Json& json, const CompactRun& run) {
  json["voxels"] = run.voxels;
  json["svo_nodes"] = run.svo_nodes;
  json["dag_nodes"] = run.dag_nodes;
  json["build_seconds"] = std::isnan(run.build_seconds) ? Json() : Json(run.build_seconds);
  json["forms"] = Json::object();
  for (const FormResult& result : run.forms)
    json["forms"][result.form->key] = form_json(run, result);
}

}  // namespace

Json compact_json(const CompactResults& results, const Json& machine) {
  Json json = scene_runs_json(results.runs, machine, add_figures);
  json["geometric_means"] = Json::object();
  for (const FormMeans& mean : form_means(results))
    json["geometric_means"][mean.form->key] = {{"runs", mean.runs},
                                               {"of_svdag", mean.part_of_reference},
                                               {"bits_per_voxel", mean.bits_per_voxel}};
  return json;
}

}  // namespace voxdag::lab
