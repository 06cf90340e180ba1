#pragma once
/// Implements `voxdag bench papers`: measures the tables and figures of both papers again, and
/// writes a report with the published figures beside ours.
#include <filesystem>

#include "bench/reproduce/papers_plan.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

struct PapersReport {
  std::filesystem::path html, markdown, json;
  std::size_t measured = 0, kept = 0;  ///< Runs, and results of earlier runs of the report.
  bool has_charts = false;             ///< False if matplotlib is not installed.
};

/// Returns about the seconds that the plan takes if nothing is kept, on two cores.
double typical_seconds(const PapersPlan& plan);

/// Runs the plan. Writes report.html, report.md, report.json, the charts, and one file per run in
/// cells/ to the plan's folder, which is made if it does not exist. An interrupted run keeps its
/// finished measurements. Throws Error, also if the chosen device is missing, and Cancelled.
PapersReport bench_papers(const PapersPlan& plan, Progress& progress);

}  // namespace voxdag
