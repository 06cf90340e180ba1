#include "bench/reproduce/svdag_builds.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "bench/reproduce/table_text.hpp"

namespace voxdag {
namespace {

using Json = nlohmann::ordered_json;

Json build_json(const SeriesBuild& build) {
  Json json{{"resolution", std::int64_t{1} << build.levels},
            {"command", command_of(build.cell)},
            {"wall_seconds", build.result.cost.wall_seconds},
            {"cpu_seconds", build.result.cost.cpu_seconds()},
            {"peak_memory_bytes", build.result.cost.peak_bytes}};
  if (build.result.failure.empty())
    json["result"] = build.result.json;
  else
    json["failure"] = build.result.failure;
  return json;
}

Json builds_json(const std::vector<SeriesBuild>& builds) {
  Json array = Json::array();
  for (const SeriesBuild& build : builds) array.push_back(build_json(build));
  return array;
}

}  // namespace

std::string SvdagSceneBuilds::title() const {
  return fmt::format("{} ({})", scene.scene->name, scene.state());
}

SvdagSceneBuilds build_svdag_scene(const PapersPlan& plan, const FoundScene& scene,
                                   CellStore& cells, Progress& progress) {
  SvdagSceneBuilds builds;
  builds.scene = scene;
  if (scene.is_absent()) return builds;
  const auto series = [&](BuildKind kind, const std::vector<int>& levels) {
    return build_series(plan, kind, scene.mesh, levels, cells, progress);
  };
  builds.by_paper = series(BuildKind::kPaper, plan.table1_levels);
  builds.by_hash = series(BuildKind::kHash, plan.table1_levels);
  builds.dags = series(BuildKind::kHash, plan.table2_levels);
  builds.esvos = series(BuildKind::kEsvo, plan.table2_levels);
  builds.shapes = series(BuildKind::kShape, plan.table2_levels);
  return builds;
}

std::vector<int> levels_of(const std::vector<SvdagSceneBuilds>& scenes, SeriesMember series) {
  std::set<int> levels;
  for (const SvdagSceneBuilds& scene : scenes)
    for (const SeriesBuild& build : scene.*series) levels.insert(build.levels);
  return {levels.begin(), levels.end()};
}

double value_at(const std::vector<SeriesBuild>& builds, int levels,
                const std::function<double(const CellResult&)>& read) {
  for (const SeriesBuild& build : builds)
    if (build.levels == levels && build.result.failure.empty()) return read(build.result);
  return NAN;
}

double dag_nodes(const CellResult& result) { return result.json.at("dag_nodes").get<double>(); }

double dag_bytes(const CellResult& result) {
  return result.json.at("bytes").at("svdag_paper").get<double>();
}

double svo_nodes(const CellResult& result) { return result.json.at("svo_nodes").get<double>(); }

double esvo_nodes(const CellResult& result) { return result.json.at("descriptors").get<double>(); }

double esvo_bytes(const CellResult& result) { return 8 * esvo_nodes(result); }

double stage_seconds(const CellResult& result, const char* stage) {
  return result.json.at("seconds").at(stage).get<double>();
}

void add_commands(Section& section, const std::vector<SvdagSceneBuilds>& scenes,
                  SeriesMember series) {
  const auto built = std::find_if(scenes.begin(), scenes.end(),
                                  [&](const auto& scene) { return !(scene.*series).empty(); });
  if (built == scenes.end()) return;
  section.parts.emplace_back(CommandLine{command_of(((*built).*series).back().cell)});
  for (const SvdagSceneBuilds& scene : scenes)
    for (const SeriesBuild& build : scene.*series)
      if (!build.result.failure.empty()) {
        section.parts.emplace_back(
            Paragraph{fmt::format("{} at {}: {}.", scene.scene.scene->name,
                                  resolution_text(build.levels), build.result.failure)});
        break;  // the finer ones have the same reason
      }
}

Json svdag_builds_json(const std::vector<SvdagSceneBuilds>& scenes) {
  Json array = Json::array();
  for (const SvdagSceneBuilds& builds : scenes)
    array.push_back({{"scene", builds.scene.scene->name},
                     {"state", builds.scene.state()},
                     {"difference", builds.scene.match.difference},
                     {"mesh", builds.scene.mesh.filename().string()},
                     {"paper_method", builds_json(builds.by_paper)},
                     {"voxdag_method", builds_json(builds.by_hash)},
                     {"dags", builds_json(builds.dags)},
                     {"esvos", builds_json(builds.esvos)},
                     {"esvo_shapes", builds_json(builds.shapes)}});
  return array;
}

}  // namespace voxdag
