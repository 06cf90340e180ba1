#pragma once
/// The report's sections about the ESVO paper's tables and claims.
#include <vector>

#include "lab/report/charts.hpp"
#include "lab/reproduce/esvo/esvo_runs.hpp"

namespace voxdag::lab {

/// Table 1: memory and construction time. `threads`: of our builds.
Section esvo_table1_section(const std::vector<EsvoSceneRuns>& scenes, int threads);
/// Returns a chart of memory and time over the resolution; or nothing.
std::vector<Chart> esvo_table1_charts(const std::vector<EsvoSceneRuns>& scenes);

/// Table 2: primary rays at triangles, cubes and contours.
Section esvo_table2_section(const std::vector<EsvoSceneRuns>& scenes);
/// Returns a chart of the rates over the resolution, a panel for each scene; or nothing.
std::vector<Chart> esvo_table2_charts(const std::vector<EsvoSceneRuns>& scenes);

/// How well silhouettes of cubes and of contours agree with those of the triangles.
Section silhouettes_section(const std::vector<EsvoSceneRuns>& scenes);
/// Returns a chart of the errors over the resolution; or nothing.
std::vector<Chart> silhouettes_charts(const std::vector<EsvoSceneRuns>& scenes);

/// Returns a table with a line for each claim: reproduced, not reproduced, or not measured.
Section esvo_claims_section(const std::vector<EsvoSceneRuns>& scenes);

}  // namespace voxdag::lab
