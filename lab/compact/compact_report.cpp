/// The table, the JSON and the chart of `voxdag bench compact`.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "lab/compact/bench_compact.hpp"
#include "voxdag/file/report/human.hpp"

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

std::string compact_table(const CompactResults& results) {
  std::size_t width = 14;
  for (const CompactRun& run : results.runs) width = std::max(width, run.scene.size());
  const auto line = [&](const std::string& scene, const std::string& grid,
                        const std::string& voxels, const std::string& form,
                        const std::string& bytes, const std::string& part, const std::string& bits,
                        const std::string& seconds) {
    return fmt::format("{:<{}} {:>9} {:>17}  {:<8} {:>15} {:>9} {:>11} {:>9}\n", scene, width, grid,
                       voxels, form, bytes, part, bits, seconds);
  };
  std::string text =
      line("scene", "grid", "voxels", "form", "bytes", "of SVDAG", "bits/voxel", "seconds");
  for (const CompactRun& run : results.runs) {
    if (!run.failure.empty()) {
      text += fmt::format("{:<{}} {:>9}  failed: {}\n", run.scene, width,
                          run.levels == 0 ? "" : resolution_text(run.levels), run.failure);
      continue;
    }
    bool is_first = true;
    for (const FormResult& result : run.forms) {
      text += line(
          is_first ? run.scene : "", is_first ? resolution_text(run.levels) : "",
          is_first ? with_commas(run.voxels) : "", result.form->title,
          with_commas(result.size.bytes()), fmt::format("{:.3f}", run.part_of_reference(result)),
          fmt::format("{:.4f}", run.bits_per_voxel(result)), fmt::format("{:.2f}", result.seconds));
      is_first = false;
    }
  }
  const std::vector<FormMeans> means = form_means(results);
  if (means.empty() || means.front().runs < 2) return text;
  text += "\n";
  for (const FormMeans& mean : means)
    text += line(&mean == &means.front() ? "geometric mean" : "", "",
                 &mean == &means.front() ? fmt::format("of {} rows", mean.runs) : "",
                 mean.form->title, "", fmt::format("{:.3f}", mean.part_of_reference),
                 fmt::format("{:.4f}", mean.bits_per_voxel), "");
  return text;
}

Chart compact_chart(const CompactResults& results, const std::filesystem::path& file) {
  std::map<int, std::vector<const CompactRun*>> by_levels;
  for (const CompactRun& run : results.runs)
    if (run.failure.empty()) by_levels[run.levels].push_back(&run);
  Chart chart{file, {}};
  for (const auto& [levels, runs] : by_levels) {
    ChartPanel panel;
    panel.title = resolution_text(levels) + "³";
    panel.y.label = "bits per voxel";
    for (const CompactRun* run : runs)
      panel.groups.push_back(std::filesystem::path(run->scene).stem());
    for (std::size_t i = 0; i < runs.front()->forms.size(); ++i) {
      const CompactForm& form = *runs.front()->forms[i].form;
      if (!form.is_random_access) continue;
      ChartLine bars{form.title, {}, {}, static_cast<int>(&form - compact_forms().data())};
      for (const CompactRun* run : runs) bars.y.push_back(run->bits_per_voxel(run->forms[i]));
      panel.lines.push_back(std::move(bars));
    }
    if (!panel.lines.empty()) chart.panels.push_back(std::move(panel));
  }
  if (chart.panels.empty()) throw Error("there is nothing to plot");
  return chart;
}

}  // namespace voxdag::lab
