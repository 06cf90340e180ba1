/// Writes the JSON of `voxdag bench build --json`.
#include <cmath>

#include "lab/build/bench_report.hpp"
#include "lab/papers/paper_json.hpp"
#include "lab/papers/svdag_published.hpp"
#include "lab/report/bench_machine.hpp"

namespace voxdag::lab {
namespace {

using Json = nlohmann::ordered_json;

Json cost_json(const ProcessCost& cost) {
  return {{"wall_seconds", cost.wall_seconds},
          {"cpu_seconds", cost.cpu_seconds()},
          {"user_seconds", cost.user_seconds},
          {"system_seconds", cost.system_seconds},
          {"peak_memory_bytes", cost.peak_bytes}};
}

void add_published(Json& json, const BuildRun& run) {
  const auto paper = published::reduction_of(run.paper, run.levels);
  add_paper_scene(json, run.paper);
  if (run.method != "paper" || !paper) return;
  json["published"] = {{"source", published::kSource},
                       {"scene", paper->scene},
                       {"reduce_seconds", paper->total},
                       {"sort_seconds", paper->sorting},
                       {"cores", published::kCores}};
}

Json build_json(const std::vector<BuildRun>& builds, std::size_t index) {
  const BuildRun& run = builds[index];
  Json json{{"scene", run.scene},
            {"resolution", std::int64_t{1} << run.levels},
            {"method", run.method},
            {"threads", run.threads},
            {"load_before", run.load_before}};
  if (!run.failure.empty()) json["failure"] = run.failure;
  json.update(cost_json(run.cost));
  if (!run.failure.empty()) return json;
  json["stage_seconds"] = Json::object();
  for (const auto& [stage, seconds] : run.stage_seconds) json["stage_seconds"][stage] = seconds;
  json["triangles"] = run.triangles;
  json["vertices"] = run.vertices;
  json["mesh_bytes"] = run.mesh_bytes();
  json["voxels"] = run.voxels;
  json["voxels_per_second"] = run.voxels_per_second();
  json["svo_nodes"] = run.svo_nodes;
  json["dag_nodes"] = run.dag_nodes;
  json["dag_bytes"] = run.dag_bytes;
  json["file_bytes"] = run.file_bytes;
  json["memory_allowance_bytes"] = run.memory_allowance();
  json["memory_ratio"] = run.memory_ratio();
  if (const Growth growth = growth_to(builds, index); growth.wall > 0)
    json["growth_per_level"] = {{"wall", growth.wall},
                                {"cpu", growth.cpu},
                                {"voxels", growth.voxels},
                                {"dag_bytes", growth.dag_bytes}};
  add_published(json, run);
  return json;
}

Json rival_json(const RivalRun& run) {
  const RivalBuild& build = run.build;
  Json json{{"name", run.name},
            {"command", build.command},
            {"scene", run.scene},
            {"resolution", std::int64_t{1} << run.levels},
            {"load_before", run.load_before}};
  if (!build.failure.empty()) json["failure"] = build.failure;
  json.update(cost_json(build.cost));
  json["output_bytes"] = build.output_bytes;
  if (!build.reported.empty()) json["reported"] = Json::parse(build.reported);
  return json;
}

}  // namespace

Growth growth_to(const std::vector<BuildRun>& builds, std::size_t index) {
  if (index == 0) return {};
  const BuildRun &from = builds[index - 1], &to = builds[index];
  const int levels = to.levels - from.levels;
  if (from.scene != to.scene || from.method != to.method || levels <= 0 || !to.failure.empty())
    return {};
  const auto per_level = [&](auto a, auto b) {
    return std::pow(static_cast<double>(b) / static_cast<double>(a), 1.0 / levels);
  };
  return {per_level(from.cost.wall_seconds, to.cost.wall_seconds),
          per_level(from.cost.cpu_seconds(), to.cost.cpu_seconds()),
          per_level(from.voxels, to.voxels), per_level(from.dag_bytes, to.dag_bytes)};
}

Json bench_json(const BenchResults& results, const Json& machine) {
  Json json{{"program", program_name()}, {"machine", machine}};
  json["builds"] = Json::array();
  for (std::size_t i = 0; i < results.builds.size(); ++i)
    json["builds"].push_back(build_json(results.builds, i));
  json["rivals"] = Json::array();
  for (const RivalRun& run : results.rivals) json["rivals"].push_back(rival_json(run));
  return json;
}

}  // namespace voxdag::lab
