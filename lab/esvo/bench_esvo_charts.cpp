/// Draws the charts of `voxdag bench esvo`.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "lab/esvo/bench_esvo.hpp"
#include "lab/papers/esvo_published.hpp"
#include "voxdag/file/report/human.hpp"

namespace voxdag::lab {
namespace {

double resolution(int levels) { return std::ldexp(1.0, levels); }

ChartPanel panel_of(std::string title, std::string unit) {
  return {std::move(title),
          {"resolution", AxisScale::kLog2},
          {std::move(unit), AxisScale::kLog10},
          {},
          {}};
}

/// Returns the rows of each scene, in the order of the rows.
template <class Row>
std::vector<std::vector<const Row*>> by_scene(const std::vector<Row>& rows) {
  std::vector<std::vector<const Row*>> scenes;
  for (const Row& row : rows) {
    if (scenes.empty() || scenes.back().back()->scene != row.scene) scenes.emplace_back();
    scenes.back().push_back(&row);
  }
  return scenes;
}

void add_line(ChartLine line, ChartPanel& panel) {
  if (!line.x.empty()) panel.lines.push_back(std::move(line));
}

ChartLine published_line(const published::EsvoScene& scene,
                         std::array<double, 7> published::EsvoScene::*values, int color) {
  ChartLine line{"", {}, {}, color, LineStyle::kDashed};
  for (std::size_t i = 0; i < (scene.*values).size(); ++i) {
    line.x.push_back(resolution(published::kEsvoFirstLevels + static_cast<int>(i)));
    line.y.push_back((scene.*values)[i]);
  }
  return line;
}

/// Adds the lines of contours (solid), cubes (dotted) and the paper (dashed) of all scenes.
template <class Value>
void add_builds(const std::vector<EsvoBuildRun>& builds, const Value& value,
                std::array<double, 7> published::EsvoScene::*values, ChartPanel& panel) {
  int color = 0;
  for (const auto& runs : by_scene(builds)) {
    ChartLine contours{runs[0]->scene, {}, {}, color, LineStyle::kSolid, true};
    ChartLine cubes{"", {}, {}, color, LineStyle::kDotted};
    for (const EsvoBuildRun* run : runs) {
      if (!run->failure.empty()) continue;
      ChartLine& line = run->with_contours ? contours : cubes;
      line.x.push_back(resolution(run->levels));
      line.y.push_back(value(*run));
    }
    add_line(std::move(contours), panel);
    add_line(std::move(cubes), panel);
    const published::EsvoScene* paper = published::esvo_scene(runs[0]->paper);
    if (paper != nullptr) add_line(published_line(*paper, values, color), panel);
    ++color;
  }
}

ChartPanel silhouettes_panel(const std::vector<SilhouetteRow>& rows) {
  ChartPanel panel =
      panel_of("Rays on the wrong side of a silhouette; dotted: cubes", "per million");
  int color = 0;
  for (const auto& scene : by_scene(rows)) {
    ChartLine contours{scene[0]->scene, {}, {}, color, LineStyle::kSolid, true};
    ChartLine cubes{"", {}, {}, color++, LineStyle::kDotted};
    for (const SilhouetteRow* row : scene)
      for (const auto& [line, wrong] :
           {std::pair{&contours, row->contours}, std::pair{&cubes, row->cubes}}) {
        if (!(wrong > 0)) continue;
        line->x.push_back(resolution(row->levels));
        line->y.push_back(wrong * 1e6);
      }
    add_line(std::move(contours), panel);
    add_line(std::move(cubes), panel);
  }
  return panel;
}

ChartPanel rays_panel(const std::vector<const EsvoRateRow*>& rows, int coarse) {
  const auto name_of_grid = [](int levels) {
    return with_commas(std::uint64_t{1} << levels) + "³";
  };
  ChartPanel panel;
  panel.title = rows[0]->scene + " " + name_of_grid(rows[0]->levels) +
                (coarse == 0 ? std::string() : fmt::format(", coarse: {}", name_of_grid(coarse)));
  panel.y.label = "million primary rays per second";
  for (const EsvoRateRow* row : rows)
    panel.groups.push_back(fmt::format("{} × {}", row->size.width, row->size.height));
  for (std::size_t form = 0; form < kEsvoForms.size(); ++form) {
    ChartLine line{name_of(kEsvoForms[form]), {}, {}, static_cast<int>(form)};
    for (const EsvoRateRow* row : rows) line.y.push_back(row->mrays_per_second[form]);
    const bool is_measured =
        std::any_of(line.y.begin(), line.y.end(), [](double rate) { return !std::isnan(rate); });
    if (is_measured) panel.lines.push_back(std::move(line));
  }
  return panel;
}

}  // namespace

Chart esvo_bench_chart(const EsvoBenchResults& results, const std::filesystem::path& file) {
  ChartPanel memory = panel_of("Memory; dotted: cubes, dashed: the paper", "MB (2^20 bytes)");
  ChartPanel time = panel_of("Construction; dotted: cubes, dashed: the paper", "seconds");
  add_builds(
      results.builds, [](const EsvoBuildRun& run) { return run.megabytes(); },
      &published::EsvoScene::megabytes, memory);
  add_builds(
      results.builds, [](const EsvoBuildRun& run) { return run.build_seconds; },
      &published::EsvoScene::seconds, time);
  if (memory.lines.empty()) throw Error("there is nothing to plot");
  Chart chart{file, {memory, time}};
  const ChartPanel silhouettes = silhouettes_panel(results.silhouettes);
  if (!silhouettes.lines.empty()) chart.panels.push_back(silhouettes);
  return chart;
}

Chart esvo_rays_chart(const EsvoBenchResults& results, const std::filesystem::path& file) {
  Chart chart{file, {}};
  for (const auto& rows : by_scene(results.rates))
    chart.panels.push_back(rays_panel(rows, coarse_levels(results.silhouettes, rows[0]->scene)));
  if (chart.panels.empty()) throw Error("there are no rays to plot");
  return chart;
}

}  // namespace voxdag::lab
