#pragma once
/// The program in lab/report, which is written in Python: it prints tables, draws plots, and runs
/// benchmarks that only start other programs.
#include <string>
#include <vector>

#include "voxdag/core/parallel/progress.hpp"

namespace voxdag::lab {

/// Returns the command that runs the program: the folder "report" beside this program or, if it is
/// not there, that of the sources.
std::vector<std::string> report_command(const std::vector<std::string>& arguments);

/// Runs the program and returns its standard output. Throws Error with the line that it wrote to
/// standard error if it fails, and Cancelled.
std::string run_report(const std::vector<std::string>& arguments, const Progress& progress);

}  // namespace voxdag::lab
