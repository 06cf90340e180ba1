#include "voxdag/builders/dag/build_svdag.hpp"

#include <algorithm>
#include <string>

#include "voxdag/builders/dag/build_methods.hpp"
#include "voxdag/builders/dag/estimate_memory.hpp"
#include "voxdag/builders/dag/stop_watch.hpp"

namespace voxdag {
namespace {

std::string mebibytes(std::uint64_t bytes) {
  return std::to_string((bytes + (std::uint64_t{1} << 20) - 1) >> 20) + " MiB";
}

[[noreturn]] void refuse(const MemoryBudget& budget, const std::string& needed) {
  throw OverMemory("the memory limit of " + mebibytes(budget.limit()) +
                   " is too small: the build needs " + needed);
}

/// Throws OverMemory if the limit is clearly too small, before any long work.
void check_memory(const BuildInput& input) {
  // The finer estimate is this many levels coarser than the build, and takes about a hundredth of
  // its time.
  constexpr int kSteps = 4;
  const MemoryBudget& budget = *input.work.memory;
  if (budget.limit() == 0 || area_bound(input.mesh, input.grid) < budget.left() / 2) return;
  const auto needed = estimate_memory(input, kSteps);
  if (!needed || *needed / 2 > budget.left()) throw OverMemory("");
}

Svdag build(const BuildInput& input, BuildReport& report) {
  StageBytes bytes;
  return input.method == BuildMethod::kHashConsed
             ? number_nodes(voxelize_hash_consed(input, report, bytes), input.grid.levels,
                            input.work, report)
             : merge_and_number(voxelize_by_sorting(input, report, bytes), input, report);
}

}  // namespace

BuildResult build_svdag(const Mesh& mesh, const Grid& grid, BuildMethod method, Work work) {
  MemoryBudget unlimited;
  const bool is_limited = work.memory != nullptr;
  if (!is_limited) work.memory = &unlimited;
  const MemoryBudget& budget = *work.memory;
  const int bin_level = method == BuildMethod::kHashConsed
                            ? hash_bin_level(grid.levels, mesh.triangles.size())
                            : sort_bin_level(grid.levels);
  const BuildInput input{mesh, grid, method, bin_level, work};
  const std::uint64_t held = budget.base() + budget.used();
  BuildResult result;
  try {
    check_memory(input);
    result.dag = build(input, result.report);
    MemoryReservation dag_bytes(work.memory, result.dag.view().bytes());
    if (is_limited) result.memory = std::move(dag_bytes);
  } catch (const OverMemory&) {
    result = {};
    if (const auto needed = estimate_memory(input, 2))
      refuse(budget, "about " + mebibytes(held + *needed));
    refuse(budget, "more than " + mebibytes(std::max(budget.limit(), held)));
  }
  result.report.peak_bytes = budget.peak();
  return result;
}

}  // namespace voxdag
