#pragma once
/// The two builders behind build_svdag(), and what they share.
#include <chrono>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/dag/build_svdag.hpp"
#include "voxdag/voxelize/grid_mapping.hpp"

namespace voxdag {

BuildResult build_hash_consed(const QuantizedMesh& mesh, int levels, MemoryBudget& budget,
                              Progress* progress);
BuildResult build_by_sorting(const QuantizedMesh& mesh, int levels, MemoryBudget& budget,
                             Progress* progress);

/// Throws the Error of a build that outgrew its limit with `fraction` of the work done.
[[noreturn]] void throw_over_memory(const MemoryBudget& budget, double fraction);

/// Seconds from lap to lap.
class StopWatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace voxdag
