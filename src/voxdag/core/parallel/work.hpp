#pragma once
/// Carries a memory budget, progress and cancellation through long operations.
#include <cstdint>
#include <string_view>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/progress.hpp"

namespace voxdag {

/// Long operations take it by value and pass it on. By default nothing limits their memory, hears
/// their reports or cancels them. The budget and the progress must outlive the work, and the budget
/// its results.
struct Work {
  Work() = default;
  Work(MemoryBudget* memory_in, Progress* progress_in = nullptr)
      : memory(memory_in), progress(progress_in) {}
  Work(Progress* progress_in) : progress(progress_in) {}

  /// Calls Progress::report().
  void report(std::string_view stage, double fraction, std::uint64_t items = 0) const {
    if (progress != nullptr) progress->report(stage, fraction, items);
  }
  /// Reports that `done` of `count` items are done.
  void report_done(std::string_view stage, std::uint64_t done, std::uint64_t count) const {
    report(stage, static_cast<double>(done) / static_cast<double>(count), done);
  }
  bool cancelled() const noexcept { return progress != nullptr && progress->cancelled(); }
  /// Throws Cancelled if the work was cancelled.
  void poll() const {
    if (progress != nullptr) progress->throw_if_cancelled();
  }
  /// Calls poll() for one in 65,536 values of `i`. For serial loops over small items.
  void poll_seldom(std::uint64_t i) const {
    if ((i & 0xFFFF) == 0) poll();
  }

  MemoryBudget* memory = nullptr;  ///< For containers and reservations. Null: counts nothing.
  Progress* progress = nullptr;    ///< Null: no reports and no cancellation.
};

}  // namespace voxdag
