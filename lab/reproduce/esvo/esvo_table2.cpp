#include <fmt/core.h>

#include "lab/papers/esvo_published.hpp"
#include "lab/reproduce/esvo/esvo_sections.hpp"
#include "lab/reproduce/table_text.hpp"

namespace voxdag::lab {
namespace {

using Json = nlohmann::ordered_json;

/// Returns the runs of the table: the finest, and the one with the depth of the paper's octree.
std::vector<const SeriesRun*> table_runs(const EsvoSceneRuns& runs) {
  const published::EsvoScene* paper = published::esvo_scene(runs.scene.match);
  const SeriesRun* finest = finest_of(runs.rays);
  std::vector<const SeriesRun*> shown;
  for (const SeriesRun& run : runs.rays) {
    const bool is_papers =
        paper != nullptr && run.levels == published::esvo_levels_of_rates(*paper);
    if (run.result.failure.empty() && (&run == finest || is_papers)) shown.push_back(&run);
  }
  return shown;
}

std::vector<ImageSize> sizes_of(const CellResult& run) {
  std::vector<ImageSize> sizes;
  for (const Json& row : run.json.at("rays")) sizes.push_back({row.at("width"), row.at("height")});
  return sizes;
}

/// Returns "47.0", or "47.0 (94.1)" with the paper's rate.
std::string rate_text(double rate, double published) {
  if (std::isnan(published)) return number_text(rate);
  return fmt::format("{} ({})", number_text(rate), number_text(published));
}

void add_rows(Table& rates, Table& costs, const EsvoSceneRuns& runs, const SeriesRun& run) {
  const published::EsvoScene* paper = published::esvo_scene(runs.scene.match);
  for (const ImageSize size : sizes_of(run.result)) {
    const std::string size_text = fmt::format("{} × {}", size.width, size.height);
    std::vector<std::string> row{runs.scene.title(), short_resolution(run.levels), size_text};
    const auto published = published::esvo_mrays(paper, run.levels, size.width, size.height);
    for (std::size_t form = 0; form < published::kEsvoRates; ++form)
      row.push_back(rate_text(esvo_rate(run.result, size, kEsvoForms[form]), published[form]));
    rates.rows.push_back(std::move(row));
    const Json& measured = *rays_of_size(run.result, size);
    const double casts = measured.at("ray_count").get<double>() * 1e-6 /
                         esvo_rate(run.result, size, EsvoForm::kContoursBeams);
    const double filter = filter_seconds(measured);
    costs.rows.push_back({runs.scene.title(), short_resolution(run.levels), size_text,
                          seconds_text(casts), seconds_text(measured.at("picture_seconds")),
                          seconds_text(filter), number_text(casts / filter)});
  }
}

}  // namespace

Section esvo_table2_section(const std::vector<EsvoSceneRuns>& scenes) {
  Table rates{
      "Million primary rays per second; in brackets: the paper's, for octrees of its depth",
      {"scene", "octree", "picture", "triangles", "cubes", "contours", "contours with beams"},
      {},
      3};
  Table costs{"Pictures of all views, without shadows and occlusion, as in the paper",
              {"scene", "octree", "picture", "casts with beams", "casts and shading", "filter",
               "casts / filter"},
              {},
              3};
  std::vector<SceneSeries> series;
  for (const EsvoSceneRuns& runs : scenes) {
    series.push_back({runs.scene, runs.rays});
    for (const SeriesRun* run : table_runs(runs)) add_rows(rates, costs, runs, *run);
  }
  Section section{"Table 2: primary rays", 2, {}};
  section.parts.emplace_back(Paragraph{
      "Four views of each scene. Rays end at cells of one pixel, as in the paper. Triangles are "
      "those of Embree on the processor: single rays or packets of 16, whichever is faster; a "
      "displaced surface has none. The time of beams counts. The paper's rates are those of a "
      "Quadro FX 5800, of the largest octree that fitted into its 4 GB; ours are those of the "
      "device named above, of the finest octree that the time limit allows. The two stand beside "
      "each other only for "
      "octrees of equal depth."});
  section.parts.emplace_back(std::move(rates));
  section.parts.emplace_back(Paragraph{
      "In the paper, shading costs little, and the filter takes one to two orders of magnitude "
      "less than the casts."});
  section.parts.emplace_back(std::move(costs));
  add_commands(section, series);
  return section;
}

std::vector<Chart> esvo_table2_charts(const std::vector<EsvoSceneRuns>& scenes) {
  Chart chart{"esvo-table2.svg", {}};
  for (const EsvoSceneRuns& runs : scenes) {
    const SeriesRun* finest = finest_of(runs.rays);
    if (finest == nullptr || sizes_of(finest->result).empty()) continue;
    const ImageSize size = sizes_of(finest->result).back();
    ChartPanel panel{fmt::format("{}, {} × {}", runs.scene.title(), size.width, size.height),
                     {"resolution", AxisScale::kLog2},
                     {"million rays per second", {}},
                     {}};
    for (std::size_t form = 0; form < published::kEsvoRates; ++form) {
      static constexpr const char* kLabels[] = {"triangles (Embree)", "cubes", "contours",
                                                "contours with beams"};
      static constexpr int kColors[] = {1, 3, 2, 0};
      ChartLine line{kLabels[form], {}, {}, kColors[form], LineStyle::kSolid, true};
      for (const SeriesRun& run : runs.rays) {
        if (!run.result.failure.empty()) continue;
        line.x.push_back(std::exp2(run.levels));
        line.y.push_back(esvo_rate(run.result, size, kEsvoForms[form]));
      }
      if (!std::isnan(line.y.back())) panel.lines.push_back(std::move(line));
    }
    chart.panels.push_back(std::move(panel));
  }
  if (chart.panels.empty()) return {};
  return {chart};
}

}  // namespace voxdag::lab
