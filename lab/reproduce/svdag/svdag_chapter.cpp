#include "lab/reproduce/svdag/svdag_chapter.hpp"

#include "lab/reproduce/svdag/svdag_claims.hpp"
#include "lab/reproduce/svdag/svdag_sections.hpp"

namespace voxdag::lab {

SvdagResults measure_svdag(const PapersPlan& plan, const std::vector<FoundScene>& scenes,
                           CellStore& cells, Progress& progress) {
  SvdagResults results;
  results.scenes = scenes;
  for (const FoundScene& scene : results.scenes)
    results.builds.push_back(build_svdag_scene(plan, scene, cells, progress));
  results.figure1 = measure_figure1(plan, results.scenes, cells, progress);
  results.pictures = render_pictures(plan, results.scenes, cells, progress);
  results.flight = measure_flight(plan, results.scenes, cells);
  return results;
}

std::vector<RunItem> svdag_items(const PapersPlan& plan, const std::vector<FoundScene>& scenes,
                                 CellStore& cells, Progress& progress) {
  std::vector<RunItem> items = flight_items(plan, scenes, cells);
  items.push_back([&] { measure_figure1(plan, scenes, cells, progress); });
  for (const FoundScene& scene : scenes)
    for (RunItem& item : svdag_build_items(plan, scene, cells, progress))
      items.push_back(std::move(item));
  for (RunItem& item : picture_items(plan, scenes, cells, progress))
    items.push_back(std::move(item));
  return items;
}

std::vector<Chart> svdag_charts(const SvdagResults& results) {
  std::vector<Chart> charts = figure5_charts(results.builds);
  if (results.flight)
    for (Chart& chart : flight_charts(*results.flight)) charts.push_back(std::move(chart));
  return charts;
}

std::vector<Section> svdag_chapter(const SvdagResults& results, int threads, bool is_drawn) {
  std::vector<Section> sections{
      {"High Resolution Sparse Voxel DAGs (Kämpe, Sintorn, Assarsson 2013)", 1, {}},
      scenes_section(results.scenes),
      svdag_claims_section(results.builds, results.flight),
      table1_section(results.builds, threads),
      table2_section(results.builds),
      figure5_section()};
  add_charts(sections.back(), figure5_charts(results.builds),
             "Figure 5: nodes per level of DAGs of several resolutions, and of the SVO of the "
             "highest one.",
             is_drawn);
  if (results.figure1) sections.push_back(figure1_section(*results.figure1));
  sections.push_back(figure4_section(results.pictures));
  if (results.flight)
    for (Section& section : flight_sections(*results.flight, is_drawn))
      sections.push_back(std::move(section));
  sections.push_back(figure8b_section(results.pictures));
  return sections;
}

nlohmann::ordered_json svdag_json(const SvdagResults& results) {
  return {{"scenes", svdag_builds_json(results.builds)},
          {"figure1", results.figure1 ? figure1_json(*results.figure1) : nlohmann::ordered_json()},
          {"flight", results.flight ? flight_json(*results.flight) : nlohmann::ordered_json()}};
}

}  // namespace voxdag::lab
