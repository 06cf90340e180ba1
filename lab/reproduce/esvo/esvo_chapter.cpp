#include "lab/reproduce/esvo/esvo_chapter.hpp"

#include <algorithm>

#include "lab/reproduce/esvo/esvo_sections.hpp"

namespace voxdag::lab {
namespace {

/// Returns the scan, or the first scene that is there if the scan is not.
FoundScene close_up_of(const FoundScene& scan, const std::vector<FoundScene>& scenes) {
  if (!scan.is_absent()) return scan;
  const auto first = std::find_if(scenes.begin(), scenes.end(), [](const FoundScene& scene) {
    return !scene.is_absent() && !scene.identity.is_displaced;
  });
  return first == scenes.end() ? scan : *first;
}

}  // namespace

EsvoResults measure_esvo(const PapersPlan& plan, const std::vector<FoundScene>& scenes,
                         const FoundScene& scan, CellStore& cells, Progress& progress) {
  EsvoResults results;
  results.scenes = scenes;
  for (const FoundScene& scene : results.scenes)
    results.runs.push_back(measure_esvo_scene(plan, scene, cells, progress));
  results.pictures = render_esvo_pictures(plan, results.scenes, close_up_of(scan, results.scenes),
                                          cells, progress);
  return results;
}

std::vector<RunItem> esvo_items(const PapersPlan& plan, const std::vector<FoundScene>& scenes,
                                const FoundScene& scan, CellStore& cells, Progress& progress) {
  std::vector<RunItem> items;
  for (const FoundScene& scene : scenes)
    for (RunItem& item : esvo_run_items(plan, scene, cells, progress))
      items.push_back(std::move(item));
  for (RunItem& item : esvo_picture_items(plan, scenes, close_up_of(scan, scenes), cells, progress))
    items.push_back(std::move(item));
  return items;
}

std::vector<Chart> esvo_charts(const EsvoResults& results) {
  std::vector<Chart> charts;
  for (const auto& some : {esvo_table1_charts(results.runs), esvo_table2_charts(results.runs),
                           silhouettes_charts(results.runs)})
    charts.insert(charts.end(), some.begin(), some.end());
  return charts;
}

std::vector<Section> esvo_chapter(const EsvoResults& results, int threads, bool is_drawn) {
  const std::vector<EsvoSceneRuns>& runs = results.runs;
  Section table1 = esvo_table1_section(runs, threads), table2 = esvo_table2_section(runs),
          silhouettes = silhouettes_section(runs);
  add_charts(table1, esvo_table1_charts(runs),
             "Table 1: memory and construction time over the resolution; dashed: published.",
             is_drawn);
  add_charts(table2, esvo_table2_charts(runs), "Table 2: primary rays over the resolution.",
             is_drawn);
  add_charts(silhouettes, silhouettes_charts(runs),
             "Rays on the wrong side of a silhouette; dashed: cubes.", is_drawn);
  std::vector<Section> sections{{"Efficient Sparse Voxel Octrees (Laine, Karras 2010)", 1, {}},
                                scenes_section(results.scenes),
                                esvo_claims_section(runs),
                                std::move(table1),
                                std::move(table2),
                                std::move(silhouettes)};
  for (Section& section : esvo_picture_sections(results.pictures))
    sections.push_back(std::move(section));
  return sections;
}

nlohmann::ordered_json esvo_json(const EsvoResults& results) {
  return {{"scenes", esvo_runs_json(results.runs)}};
}

}  // namespace voxdag::lab
