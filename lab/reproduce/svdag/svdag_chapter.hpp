#pragma once
/// The report's chapter about the SVDAG paper.
#include <optional>
#include <vector>

#include "lab/reproduce/svdag/flight.hpp"
#include "lab/reproduce/svdag/svdag_builds.hpp"
#include "lab/reproduce/svdag/svdag_figure1.hpp"
#include "lab/reproduce/svdag/svdag_pictures.hpp"

namespace voxdag::lab {

struct SvdagResults {
  std::vector<FoundScene> scenes;
  std::vector<SvdagSceneBuilds> builds;
  std::optional<SvdagFigure1> figure1;
  SvdagPictures pictures;
  std::optional<Flight> flight;
};

/// Measures the tables and figures of the SVDAG paper in its scenes. Throws Error and Cancelled.
SvdagResults measure_svdag(const PapersPlan& plan, const std::vector<FoundScene>& scenes,
                           CellStore& cells, Progress& progress);

/// Returns the runs of measure_svdag() as items, about the longest first. The arguments must live
/// as long as the items.
std::vector<RunItem> svdag_items(const PapersPlan& plan, const std::vector<FoundScene>& scenes,
                                 CellStore& cells, Progress& progress);

std::vector<Chart> svdag_charts(const SvdagResults& results);

/// Returns the sections of the chapter. `threads`: of our builds. `is_drawn`: whether the charts
/// are there.
std::vector<Section> svdag_chapter(const SvdagResults& results, int threads, bool is_drawn);

nlohmann::ordered_json svdag_json(const SvdagResults& results);

}  // namespace voxdag::lab
