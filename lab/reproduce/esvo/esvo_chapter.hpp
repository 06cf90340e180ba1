#pragma once
/// The report's chapter about the ESVO paper.
#include <vector>

#include "lab/report/charts.hpp"
#include "lab/reproduce/esvo/esvo_pictures.hpp"
#include "lab/reproduce/esvo/esvo_runs.hpp"

namespace voxdag::lab {

struct EsvoResults {
  std::vector<FoundScene> scenes;
  std::vector<EsvoSceneRuns> runs;
  EsvoPictures pictures;
};

/// Measures the tables and figures of the ESVO paper in its scenes. `scan`: a smooth model for
/// close-ups; if it is absent, the first scene serves. Throws Error and Cancelled.
EsvoResults measure_esvo(const PapersPlan& plan, const std::vector<FoundScene>& scenes,
                         const FoundScene& scan, CellStore& cells, Progress& progress);

/// Returns the runs of measure_esvo() as items, about the longest first. The arguments must live as
/// long as the items.
std::vector<RunItem> esvo_items(const PapersPlan& plan, const std::vector<FoundScene>& scenes,
                                const FoundScene& scan, CellStore& cells, Progress& progress);

std::vector<Chart> esvo_charts(const EsvoResults& results);

/// Returns the sections of the chapter. `threads`: of our builds. `is_drawn`: whether the charts
/// are there.
std::vector<Section> esvo_chapter(const EsvoResults& results, int threads, bool is_drawn);

nlohmann::ordered_json esvo_json(const EsvoResults& results);

}  // namespace voxdag::lab
