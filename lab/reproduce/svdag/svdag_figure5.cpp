#include <algorithm>

#include "lab/reproduce/svdag/svdag_sections.hpp"
#include "lab/reproduce/table_text.hpp"

namespace voxdag::lab {
namespace {

/// Returns the scenes with those of the paper's Figure 5 first.
std::vector<SvdagSceneBuilds> figure5_order(std::vector<SvdagSceneBuilds> scenes) {
  std::stable_partition(scenes.begin(), scenes.end(), [](const SvdagSceneBuilds& builds) {
    return builds.scene.scene->name == "Crysponza" || builds.scene.scene->name == "SanMiguel";
  });
  return scenes;
}

ChartLine line_of(const nlohmann::ordered_json& nodes_per_level) {
  ChartLine line;
  for (std::size_t level = 0; level < nodes_per_level.size(); ++level) {
    line.x.push_back(static_cast<double>(level));
    line.y.push_back(nodes_per_level[level].get<double>());
  }
  return line;
}

/// Returns the DAGs of all resolutions, and the SVO of the highest one; no lines if there are none.
ChartPanel panel_of(const SvdagSceneBuilds& builds) {
  constexpr int kSvoColor = 6;  // black
  ChartPanel panel{builds.scene.title(),
                   {"level (0: the root)", AxisScale::kLinear},
                   {"nodes", AxisScale::kLog10},
                   {}};
  const nlohmann::ordered_json* highest = nullptr;
  for (const SeriesRun& build : builds.dags) {
    if (!build.result.failure.empty()) continue;
    highest = &build.result.json;
    ChartLine dag = line_of(highest->at("dag_nodes_per_level"));
    dag.label = "DAG " + short_resolution(build.levels);
    dag.color = static_cast<int>(panel.lines.size());
    dag.markers = true;
    panel.lines.push_back(std::move(dag));
  }
  if (highest == nullptr) return panel;
  ChartLine svo = line_of(highest->at("svo_nodes_per_level"));
  svo.label = "SVO";
  svo.color = kSvoColor;
  svo.style = LineStyle::kDashed;
  panel.lines.push_back(std::move(svo));
  return panel;
}

}  // namespace

Section figure5_section() {
  return {"Figure 5: nodes per level",
          2,
          {Paragraph{"Merging opportunities grow with the resolution. The SVO has about four times "
                     "as many nodes at each level as at the level above; the lowest levels of a "
                     "DAG have few different nodes."}}};
}

std::vector<Chart> figure5_charts(const std::vector<SvdagSceneBuilds>& scenes) {
  constexpr std::size_t kMaxPanels = 2;
  Chart chart{"svdag-figure5.svg", {}};
  for (const SvdagSceneBuilds& builds : figure5_order(scenes)) {
    ChartPanel panel = panel_of(builds);
    if (!panel.lines.empty() && chart.panels.size() < kMaxPanels)
      chart.panels.push_back(std::move(panel));
  }
  if (chart.panels.empty()) return {};
  return {chart};
}

}  // namespace voxdag::lab
