#pragma once
/// The report's sections about the SVDAG paper's tables of builds, and Figure 5.
#include <vector>

#include "lab/report/charts.hpp"
#include "lab/report/document.hpp"
#include "lab/reproduce/svdag/svdag_builds.hpp"

namespace voxdag::lab {

/// Table 1: time to reduce the octree to the DAG. `threads`: of our builds.
Section table1_section(const std::vector<SvdagSceneBuilds>& scenes, int threads);

/// Table 2: nodes, memory and bits per voxel of DAG, ESVO and SVO.
Section table2_section(const std::vector<SvdagSceneBuilds>& scenes);

/// Figure 5: nodes per level. The chart is figure5_charts().
Section figure5_section();
/// Returns the chart for the paper's two scenes, or for others that were built; or nothing.
std::vector<Chart> figure5_charts(const std::vector<SvdagSceneBuilds>& scenes);

}  // namespace voxdag::lab
