#include "lab/reproduce/esvo/esvo_runs.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <cmath>

namespace voxdag::lab {
namespace {

using Json = nlohmann::ordered_json;

/// Returns the run of `voxdag bench esvo` at 2^levels.
Cell rays_cell(const PapersPlan& plan, const FoundScene& scene, int levels) {
  std::vector<std::string> options = scene.options;
  if (plan.memory_bytes > 0)
    options.insert(options.end(), {"--memory", std::to_string(plan.memory_bytes)});
  std::vector<std::string> sizes;
  for (const ImageSize size : plan.esvo.sizes)
    sizes.push_back(fmt::format("{}x{}", size.width, size.height));
  Cell cell;
  cell.inputs = {scene.mesh};
  cell.arguments = {"bench",
                    "esvo",
                    fmt::format("{}={}{}{}", scene.scene->name, scene.mesh.string(),
                                options.empty() ? "" : " ", fmt::join(options, " ")),
                    "-r",
                    std::to_string(1 << levels),
                    "--size",
                    fmt::format("{}", fmt::join(sizes, ",")),
                    "--json"};
  if (plan.threads > 0)
    cell.arguments.insert(cell.arguments.end(), {"--threads", std::to_string(plan.threads)});
  plan.device.cast(cell);
  return cell;
}

/// Reports an octree that the benchmark could not build as the run's failure.
void move_failure(SeriesRun& run) {
  if (!run.result.failure.empty()) return;
  for (const Json& build : run.result.json.at("builds"))
    if (build.contains("failure")) run.result.failure = build.at("failure");
}

std::vector<SeriesRun> build(const PapersPlan& plan, const FoundScene& scene, CellStore& cells,
                             const Progress& progress) {
  return build_series(plan, BuildKind::kEsvo, scene, plan.esvo.levels, cells, progress);
}

std::vector<SeriesRun> cast_rays(const PapersPlan& plan, const FoundScene& scene, CellStore& cells,
                                 const Progress& progress) {
  const auto make_cell = [&](int levels) { return rays_cell(plan, scene, levels); };
  return run_series(plan, plan.esvo.levels, make_cell, cells, progress);
}

}  // namespace

EsvoSceneRuns measure_esvo_scene(const PapersPlan& plan, const FoundScene& scene, CellStore& cells,
                                 const Progress& progress) {
  EsvoSceneRuns runs;
  runs.scene = scene;
  if (scene.is_absent()) return runs;
  runs.builds = build(plan, scene, cells, progress);
  runs.rays = cast_rays(plan, scene, cells, progress);
  for (SeriesRun& run : runs.rays) move_failure(run);
  return runs;
}

std::vector<RunItem> esvo_run_items(const PapersPlan& plan, const FoundScene& scene,
                                    CellStore& cells, const Progress& progress) {
  if (scene.is_absent()) return {};
  return {[&] { cast_rays(plan, scene, cells, progress); },
          [&] { build(plan, scene, cells, progress); }};
}

double esvo_megabytes(const CellResult& build) {
  return build.json.at("bytes").at("esvo").get<double>() / (1 << 20);
}

double bytes_per_voxel(const CellResult& build) {
  return build.json.at("bytes").at("esvo").get<double>() / build.json.at("voxels").get<double>();
}

const Json* rays_of_size(const CellResult& run, ImageSize size) {
  for (const Json& row : run.json.at("rays"))
    if (row.at("width") == size.width && row.at("height") == size.height) return &row;
  return nullptr;
}

double esvo_rate(const CellResult& run, ImageSize size, EsvoForm form) {
  const Json* row = rays_of_size(run, size);
  if (row == nullptr) return NAN;
  const Json& rate = row->at(name_of(form)).at("mrays_per_s");
  return rate.is_null() ? NAN : rate.get<double>();
}

double esvo_rate_on_cpu(const CellResult& run, ImageSize size, EsvoForm form) {
  const Json* row = rays_of_size(run, size);
  if (row == nullptr) return NAN;
  const Json& rate = row->at(name_of(form)).at("cpu_mrays_per_s");
  return rate.is_null() ? esvo_rate(run, size, form) : rate.get<double>();
}

double filter_seconds(const Json& row) {
  const Json& seconds = row.at("filter_seconds");
  return seconds.is_null() ? NAN : seconds.get<double>();
}

std::vector<SilhouetteRow> silhouettes_of(const EsvoSceneRuns& runs) {
  std::vector<SilhouetteRow> rows;
  for (const SeriesRun& run : runs.rays) {
    if (!run.result.failure.empty()) continue;
    for (const Json& row : run.result.json.at("silhouettes"))
      rows.push_back({std::string(runs.scene.scene->name), run.levels, row.at("cubes_wrong"),
                      row.at("contours_wrong")});
  }
  return rows;
}

Json esvo_runs_json(const std::vector<EsvoSceneRuns>& scenes) {
  Json array = Json::array();
  for (const EsvoSceneRuns& runs : scenes)
    array.push_back({{"scene", runs.scene.scene->name},
                     {"state", runs.scene.state()},
                     {"difference", runs.scene.match.difference},
                     {"mesh", runs.scene.mesh.filename().string()},
                     {"builds", series_json(runs.builds)},
                     {"rays", series_json(runs.rays)}});
  return array;
}

}  // namespace voxdag::lab
