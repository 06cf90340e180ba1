#include "voxdag/dag/build_svdag.hpp"

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <string>

#include "voxdag/dag/build_methods.hpp"

namespace voxdag {
namespace {

/// Bytes of memory that the process has resident, 0 where the system does not tell.
std::uint64_t resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  std::uint64_t total = 0, resident = 0;
  if (!(statm >> total >> resident)) return 0;
  return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

std::string mebibytes(std::uint64_t bytes) {
  return std::to_string((bytes + (std::uint64_t{1} << 20) - 1) >> 20) + " MiB";
}

}  // namespace

void throw_over_memory(const MemoryBudget& budget, double fraction) {
  std::string reason = "the memory limit is too small: the build needs more than " +
                       mebibytes(budget.limit()) + " beside what the process already held";
  if (fraction > 0.01)
    reason += ", about " +
              mebibytes(static_cast<std::uint64_t>(static_cast<double>(budget.used()) / fraction)) +
              " by what " + std::to_string(static_cast<int>(fraction * 100)) + "% of it took";
  throw Error(reason);
}

BuildResult build_svdag(const Mesh& mesh, const Grid& grid, const BuildOptions& options,
                        Progress* progress) {
  std::uint64_t limit = 0;
  if (options.memory_limit != 0) {
    const std::uint64_t held = resident_bytes();
    if (held >= options.memory_limit)
      throw Error("the memory limit of " + mebibytes(options.memory_limit) +
                  " is too small: the mesh and the program take " + mebibytes(held));
    limit = options.memory_limit - held;
  }
  MemoryBudget budget(limit);
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
