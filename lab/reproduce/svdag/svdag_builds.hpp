#pragma once
/// The builds behind the tables of the SVDAG paper.
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lab/report/document.hpp"
#include "lab/reproduce/build_series.hpp"
#include "lab/reproduce/found_scenes.hpp"
#include "lab/reproduce/run_items.hpp"

namespace voxdag::lab {

/// All builds of a scene of the SVDAG paper; none if the scene is absent.
struct SvdagSceneBuilds {
  FoundScene scene;
  std::vector<SeriesRun> by_paper;  ///< For Table 1.
  std::vector<SeriesRun> by_hash;   ///< The same resolutions, by voxdag's own method.
  std::vector<SeriesRun> dags;      ///< For Table 2 and Figure 5.
  std::vector<SeriesRun> esvos;     ///< For Table 2: with colours and normals.
  std::vector<SeriesRun> shapes;    ///< For Table 2: the shape only.
};

/// One of the series.
using SeriesMember = std::vector<SeriesRun> SvdagSceneBuilds::*;

/// Builds what the tables need.
SvdagSceneBuilds build_svdag_scene(const PapersPlan& plan, const FoundScene& scene,
                                   CellStore& cells, Progress& progress);

/// Returns the series of build_svdag_scene() as items, about the longest first.
std::vector<RunItem> svdag_build_items(const PapersPlan& plan, const FoundScene& scene,
                                       CellStore& cells, Progress& progress);

/// Returns the levels of all builds of a series, ascending.
std::vector<int> levels_of(const std::vector<SvdagSceneBuilds>& scenes, SeriesMember series);

/// What a build printed.
double dag_nodes(const CellResult& result);
double dag_bytes(const CellResult& result);
double svo_nodes(const CellResult& result);
double esvo_nodes(const CellResult& result);
/// Returns the bytes of the ESVO as the paper counts them: 8 per node for its child mask, contour
/// and pointer.
double esvo_bytes(const CellResult& result);
/// Returns the seconds of a stage: "reduce".
double stage_seconds(const CellResult& result, const char* stage);

/// Appends an example of the commands of a series, and the reasons for builds that were not made.
void add_commands(Section& section, const std::vector<SvdagSceneBuilds>& scenes,
                  SeriesMember series);

/// Returns the figures behind the tables.
nlohmann::ordered_json svdag_builds_json(const std::vector<SvdagSceneBuilds>& scenes);

}  // namespace voxdag::lab
