#include "voxdag/dag/build_svdag.hpp"

#include <string>

#include "voxdag/dag/build_methods.hpp"

namespace voxdag {
namespace {

std::string mebibytes(std::uint64_t bytes) {
  return std::to_string((bytes + (std::uint64_t{1} << 20) - 1) >> 20) + " MiB";
}

}  // namespace

void throw_over_memory(const MemoryBudget& budget, double fraction) {
  std::string reason =
      "the memory limit of " + mebibytes(budget.limit()) + " is too small: the build needs ";
  if (fraction > 0.01) {
    const double whole = static_cast<double>(budget.peak()) / fraction;
    reason += "about " + mebibytes(budget.base() + static_cast<std::uint64_t>(whole));
  } else {
    reason += "more than " + mebibytes(budget.base() + budget.peak());
  }
  throw Error(reason);
}

BuildResult build_svdag(const Mesh& mesh, const Grid& grid, const BuildOptions& options,
                        Progress* progress) {
  MemoryBudget unlimited;
  MemoryBudget& budget = options.memory != nullptr ? *options.memory : unlimited;
  budget.add(0);
  if (budget.exceeded()) throw_over_memory(budget, 0);
  StopWatch watch;
  const QuantizedMesh quantized(mesh, grid);
  budget.add(quantized.bytes());
  const double quantize_seconds = watch.lap();
  BuildResult result = options.method == BuildMethod::kSort
                           ? build_by_sorting(quantized, grid.levels, budget, progress)
                           : build_hash_consed(quantized, grid.levels, budget, progress);
  result.report.quantize_seconds += quantize_seconds;
  return result;
}

}  // namespace voxdag
