#pragma once
/// Runs for one scene at ascending resolutions: builds, and others.
#include <functional>
#include <string>
#include <vector>

#include "lab/report/document.hpp"
#include "lab/reproduce/cells.hpp"
#include "lab/reproduce/found_scenes.hpp"
#include "lab/reproduce/papers_plan.hpp"

namespace voxdag::lab {

enum class BuildKind {
  kPaper,  ///< The DAG, by the paper's method.
  kHash,   ///< The DAG, by voxdag's method.
  kEsvo,   ///< The ESVO with colours and normals, which must be uniform in a leaf.
  kShape,  ///< The ESVO's shape: no colours, no normals.
};

/// A run at one resolution, or the reason why there is none.
struct SeriesRun {
  int levels = 0;
  Cell cell;
  CellResult result;
};

/// Returns the build of the scene at 2^levels with the plan's memory and threads, and more options.
Cell build_cell(const PapersPlan& plan, const FoundScene& scene, int levels,
                const std::filesystem::path& output, const std::vector<std::string>& options);

/// Runs make_cell(levels) for each of the ascending `levels`, with the plan's time limit. After a
/// run that fails, or that predicts that the next one exceeds the limit, records the reason for the
/// others.
std::vector<SeriesRun> run_series(const PapersPlan& plan, const std::vector<int>& levels,
                                  const std::function<Cell(int levels)>& make_cell,
                                  CellStore& cells, const Progress& progress);

/// Builds the scene at each of the ascending `levels`; run_series() says when it stops.
std::vector<SeriesRun> build_series(const PapersPlan& plan, BuildKind kind, const FoundScene& scene,
                                    const std::vector<int>& levels, CellStore& cells,
                                    const Progress& progress);

/// Returns the levels of all runs, ascending.
std::vector<int> levels_of(const std::vector<const std::vector<SeriesRun>*>& all);

/// Returns the value of the run at `levels`; NaN if there is none.
double value_at(const std::vector<SeriesRun>& runs, int levels,
                const std::function<double(const CellResult&)>& read);

/// Returns the finest run that did not fail, or null.
const SeriesRun* finest_of(const std::vector<SeriesRun>& runs);

/// The runs for one scene.
struct SceneSeries {
  const FoundScene& scene;
  const std::vector<SeriesRun>& runs;
};

/// Appends an example of the commands, and for each scene the reason why its finest runs were not
/// made.
void add_commands(Section& section, const std::vector<SceneSeries>& all);

/// Returns the runs as JSON: their commands, costs and results.
nlohmann::ordered_json series_json(const std::vector<SeriesRun>& runs);

/// Returns about the seconds that build_series() takes for a scene of some hundred thousand
/// triangles on two cores.
double typical_seconds(const PapersPlan& plan, BuildKind kind, const std::vector<int>& levels);

}  // namespace voxdag::lab
