#pragma once
/// Runs voxdag on hostile inputs and measures their cost: `voxdag bench untrusted`.
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "lab/runs/child.hpp"
#include "lab/untrusted/untrusted_case.hpp"

namespace voxdag::lab {

struct UntrustedPlan {
  std::string program;           ///< The voxdag to run.
  std::string only;              ///< Runs the cases whose names contain this; empty: all.
  double timeout_seconds = 120;  ///< A command that runs longer is killed; its case fails.
};

struct UntrustedRun {
  std::string name;
  std::uint64_t input_bytes =
      0;  ///< Disk space of the input files: holes of sparse files are free.
  std::uint64_t memory_limit = 0;
  ChildResult result;
  std::string failure;  ///< The promise of docs/security.md that the case broke, or empty.

  double seconds_per_mib() const {
    return result.cost.cpu_seconds() * 1048576.0 / static_cast<double>(input_bytes);
  }
};

/// Runs the cases one after the other, each in a scratch folder. Throws Error if a process or file
/// cannot be created, and Cancelled.
std::vector<UntrustedRun> bench_untrusted(const UntrustedPlan& plan, Progress& progress);

nlohmann::ordered_json untrusted_json(const std::vector<UntrustedRun>& runs,
                                      const nlohmann::ordered_json& machine);
std::string untrusted_table(const std::vector<UntrustedRun>& runs);

}  // namespace voxdag::lab
