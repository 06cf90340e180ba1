#pragma once
/// Implements `voxdag bench papers`: measures the tables and figures of both papers again, and
/// writes a report with the published figures beside ours.
#include <filesystem>
#include <vector>

#include "lab/reproduce/papers_plan.hpp"
#include "voxdag/cluster/ranks.hpp"
#include "voxdag/core/parallel/progress.hpp"

namespace voxdag::lab {

struct PapersReport {
  std::filesystem::path html, markdown, json;
  std::size_t measured = 0, kept = 0;    ///< Runs, and results of earlier runs of the report.
  std::vector<std::size_t> measured_by;  ///< Runs of each rank; some may have made the same run.
  bool has_charts = false;               ///< False if matplotlib is not installed.
};

/// Returns about the seconds that the plan takes if nothing is kept, on two cores.
double typical_seconds(const PapersPlan& plan);

/// Runs the plan. Writes report.html, report.md, report.json, the charts, and one file per run in
/// cells/ to the plan's folder, which is made if it does not exist. An interrupted run keeps its
/// finished measurements. Throws Error, also if the chosen device is missing, and Cancelled.
///
/// Collective. The ranks share the runs; then rank 0 writes the report, and the others return an
/// empty one. All must see the plan's folder and the scenes, and have machines of one kind.
PapersReport bench_papers(const PapersPlan& plan, Ranks& ranks, Progress& progress);

}  // namespace voxdag::lab
