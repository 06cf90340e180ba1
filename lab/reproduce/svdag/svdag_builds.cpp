#include "lab/reproduce/svdag/svdag_builds.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "lab/reproduce/table_text.hpp"

namespace voxdag::lab {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

SvdagSceneBuilds build_svdag_scene(const PapersPlan& plan, const FoundScene& scene,
                                   CellStore& cells, Progress& progress) {
  SvdagSceneBuilds builds;
  builds.scene = scene;
  if (scene.is_absent()) return builds;
  const auto series = [&](BuildKind kind, const std::vector<int>& levels) {
    return build_series(plan, kind, scene, levels, cells, progress);
  };
  builds.by_paper = series(BuildKind::kPaper, plan.table1_levels);
  builds.by_hash = series(BuildKind::kHash, plan.table1_levels);
  builds.dags = series(BuildKind::kHash, plan.table2_levels);
  builds.esvos = series(BuildKind::kEsvo, plan.table2_levels);
  builds.shapes = series(BuildKind::kShape, plan.table2_levels);
  return builds;
}

std::vector<RunItem> svdag_build_items(const PapersPlan& plan, const FoundScene& scene,
                                       CellStore& cells, Progress& progress) {
  if (scene.is_absent()) return {};
  const auto series = [&plan, &scene, &cells, &progress](BuildKind kind,
                                                         const std::vector<int>& levels) {
    return [&plan, &scene, &cells, &progress, &levels, kind] {
      build_series(plan, kind, scene, levels, cells, progress);
    };
  };
  const RunItem table1 = series(BuildKind::kHash, plan.table1_levels),
                table2 = series(BuildKind::kHash, plan.table2_levels);
  return {series(BuildKind::kEsvo, plan.table2_levels),
          series(BuildKind::kShape, plan.table2_levels),
          series(BuildKind::kPaper, plan.table1_levels), [table1, table2] {
            // The tables share some of these builds.
            table1();
            table2();
          }};
}

std::vector<int> levels_of(const std::vector<SvdagSceneBuilds>& scenes, SeriesMember series) {
  std::vector<const std::vector<SeriesRun>*> all;
  for (const SvdagSceneBuilds& scene : scenes) all.push_back(&(scene.*series));
  return levels_of(all);
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
  std::vector<SceneSeries> all;
  for (const SvdagSceneBuilds& scene : scenes) all.push_back({scene.scene, scene.*series});
  add_commands(section, all);
}

Json svdag_builds_json(const std::vector<SvdagSceneBuilds>& scenes) {
  Json array = Json::array();
  for (const SvdagSceneBuilds& builds : scenes)
    array.push_back({{"scene", builds.scene.scene->name},
                     {"state", builds.scene.state()},
                     {"difference", builds.scene.match.difference},
                     {"mesh", builds.scene.mesh.filename().string()},
                     {"paper_method", series_json(builds.by_paper)},
                     {"voxdag_method", series_json(builds.by_hash)},
                     {"dags", series_json(builds.dags)},
                     {"esvos", series_json(builds.esvos)},
                     {"esvo_shapes", series_json(builds.shapes)}});
  return array;
}

}  // namespace voxdag::lab
