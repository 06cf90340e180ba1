#include <fmt/core.h>

#include "lab/papers/esvo_published.hpp"
#include "lab/reproduce/esvo/esvo_sections.hpp"
#include "lab/reproduce/resolution_table.hpp"

namespace voxdag::lab {
namespace {

double build_seconds(const CellResult& build) {
  return build.json.at("seconds").at("build").get<double>();
}

/// Returns the paper's figures for the tables; null if none belong there.
const published::EsvoScene* published_of(const FoundScene& scene) {
  return scene.shows_published() ? published::esvo_scene_named(scene.scene->name) : nullptr;
}

/// Adds a row of measured values, and one of published values below.
template <class Text>
void add_rows(ResolutionTable& table, const EsvoSceneRuns& runs, const char* what,
              double (*read)(const CellResult&),
              std::array<double, 7> published::EsvoScene::*published, const Text& text) {
  const std::string title = runs.scene.title();
  if (!runs.scene.is_absent())
    table.add(title, what, [&](int level) { return text(value_at(runs.builds, level, read)); });
  if (const published::EsvoScene* paper = published_of(runs.scene))
    table.add(title, fmt::format("{}, published", what),
              [&](int level) { return text(published::esvo_of_levels(paper->*published, level)); });
}

/// Adds the bytes per voxel of the finest octree.
void add_density(Table& table, const EsvoSceneRuns& runs) {
  const SeriesRun* finest = finest_of(runs.builds);
  const published::EsvoScene* paper = published_of(runs.scene);
  const bool is_there = finest != nullptr;
  table.rows.push_back(
      {runs.scene.title(), is_there ? short_resolution(finest->levels) : "–",
       is_there ? count_text(finest->result.json.at("voxels").get<double>()) : "–",
       is_there ? fmt::format("{:.2f}", bytes_per_voxel(finest->result)) : "–",
       paper == nullptr ? "–" : short_resolution(published::esvo_levels_of_rates(*paper)),
       paper == nullptr ? "–" : fmt::format("{:.2f}", paper->bytes_per_voxel)});
}

/// Returns lines of measured values, one for each scene, and dashed lines of published ones.
ChartPanel panel_of(const std::vector<EsvoSceneRuns>& scenes, const char* title, const char* unit,
                    double (*read)(const CellResult&),
                    std::array<double, 7> published::EsvoScene::*published) {
  ChartPanel panel{title, {"resolution", AxisScale::kLog2}, {unit, AxisScale::kLog10}, {}};
  int color = 0;
  for (const EsvoSceneRuns& runs : scenes) {
    ChartLine ours{runs.scene.title(), {}, {}, color, LineStyle::kSolid, true};
    for (const SeriesRun& run : runs.builds) {
      ours.x.push_back(std::exp2(run.levels));
      ours.y.push_back(run.result.failure.empty() ? read(run.result) : NAN);
    }
    if (!runs.scene.is_absent()) panel.lines.push_back(std::move(ours));
    if (const published::EsvoScene* paper = published_of(runs.scene)) {
      ChartLine line{
          fmt::format("{}, published", runs.scene.scene->name), {}, {}, color, LineStyle::kDashed};
      for (std::size_t i = 0; i < (paper->*published).size(); ++i) {
        line.x.push_back(std::exp2(published::kEsvoFirstLevels + static_cast<int>(i)));
        line.y.push_back((paper->*published)[i]);
      }
      panel.lines.push_back(std::move(line));
    }
    ++color;
  }
  return panel;
}

}  // namespace

Section esvo_table1_section(const std::vector<EsvoSceneRuns>& scenes, int threads) {
  std::vector<SceneSeries> series;
  std::vector<const std::vector<SeriesRun>*> builds;
  for (const EsvoSceneRuns& runs : scenes) {
    series.push_back({runs.scene, runs.builds});
    builds.push_back(&runs.builds);
  }
  const std::vector<int> levels = levels_of(builds);
  ResolutionTable memory("Memory in MB (2^20 bytes)", levels);
  ResolutionTable time(
      fmt::format("Construction time. Ours: {} threads. Published: four cores", threads), levels);
  Table density{"Bytes per voxel of the finest octree",
                {"scene", "resolution", "voxels", "bytes per voxel", "published: resolution",
                 "bytes per voxel"},
                {}};
  for (const EsvoSceneRuns& runs : scenes) {
    add_rows(memory, runs, "MB", esvo_megabytes, &published::EsvoScene::megabytes, number_text);
    add_rows(time, runs, "time", build_seconds, &published::EsvoScene::seconds, seconds_text);
    add_density(density, runs);
  }
  Section section{"Table 1: memory and construction time", 2, {}};
  section.parts.emplace_back(Paragraph{fmt::format(
      "Published: {}. Octrees have contours, colours and normals. The time covers building and "
      "writing, from the mesh in memory. voxdag ends a voxel where its shape, colours and normals "
      "are within the error bounds of `build`, by default half a voxel, 0.03 and 3 degrees. The "
      "paper does not state the bounds of its octrees.",
      published::kEsvoSource)});
  section.parts.emplace_back(memory.take());
  section.parts.emplace_back(time.take());
  section.parts.emplace_back(std::move(density));
  add_commands(section, series);
  return section;
}

std::vector<Chart> esvo_table1_charts(const std::vector<EsvoSceneRuns>& scenes) {
  Chart chart{"esvo-table1.svg",
              {panel_of(scenes, "Memory", "MB", esvo_megabytes, &published::EsvoScene::megabytes),
               panel_of(scenes, "Construction time", "seconds", build_seconds,
                        &published::EsvoScene::seconds)}};
  if (chart.panels[0].lines.empty()) return {};
  return {chart};
}

}  // namespace voxdag::lab
