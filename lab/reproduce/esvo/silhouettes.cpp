#include <fmt/core.h>

#include "lab/reproduce/esvo/esvo_sections.hpp"
#include "lab/reproduce/table_text.hpp"

namespace voxdag::lab {

namespace {

/// The finest octree of a scene has no finer cubes to compare with.
std::string saved_text(const LevelsSaved& saved) {
  if (saved.at_least && saved.levels == 0) return "–";
  return fmt::format("{}{:.1f}", saved.at_least ? "> " : "", saved.levels);
}

}  // namespace

Section silhouettes_section(const std::vector<EsvoSceneRuns>& scenes) {
  Table table{"Rays on the wrong side of a silhouette, per million",
              {"scene", "octree", "cubes", "contours", "levels of cubes saved"},
              {},
              2};
  for (const EsvoSceneRuns& runs : scenes) {
    const std::vector<SilhouetteRow> rows = silhouettes_of(runs);
    for (const SilhouetteRow& row : rows) {
      const LevelsSaved saved = levels_saved(rows, row);
      table.rows.push_back({runs.scene.title(), short_resolution(row.levels),
                            number_text(1e6 * row.cubes), number_text(1e6 * row.contours),
                            saved_text(saved)});
    }
  }
  Section section{"Contours and silhouettes", 2, {}};
  section.parts.emplace_back(Paragraph{
      "The paper says that contours save several levels, and shows it in pictures. Here, primary "
      "rays of 1024 × 768 pixels that end at the finest voxels count: those that hit a voxel but "
      "no triangle, or a triangle but no voxel. \"Levels saved\": so many levels finer cubes must "
      "be to be as good; > means that no measured cubes were as good."});
  section.parts.emplace_back(std::move(table));
  return section;
}

std::vector<Chart> silhouettes_charts(const std::vector<EsvoSceneRuns>& scenes) {
  ChartPanel panel{"Silhouettes",
                   {"resolution", AxisScale::kLog2},
                   {"wrong rays per million", AxisScale::kLog10},
                   {}};
  int color = 0;
  for (const EsvoSceneRuns& runs : scenes) {
    const std::string name(runs.scene.scene->name);
    ChartLine contours{name + ", contours", {}, {}, color, LineStyle::kSolid, true},
        cubes{name + ", cubes", {}, {}, color, LineStyle::kDashed, true};
    for (const SilhouetteRow& row : silhouettes_of(runs)) {
      contours.x.push_back(std::exp2(row.levels));
      cubes.x.push_back(std::exp2(row.levels));
      contours.y.push_back(row.contours > 0 ? 1e6 * row.contours : NAN);
      cubes.y.push_back(row.cubes > 0 ? 1e6 * row.cubes : NAN);
    }
    if (contours.x.empty()) continue;
    panel.lines.push_back(std::move(contours));
    panel.lines.push_back(std::move(cubes));
    ++color;
  }
  if (panel.lines.empty()) return {};
  return {{"esvo-silhouettes.svg", {panel}}};
}

}  // namespace voxdag::lab
