#pragma once
/// How long work tells its caller how far it is, and how the caller stops it.
#include <atomic>
#include <cstdint>
#include <functional>
#include <string_view>

#include "voxdag/core/error.hpp"

namespace voxdag {

/// Passed by pointer to long operations; null means "nobody listens". Callbacks may come from any
/// thread, one at a time.
class Progress {
 public:
  /// `fraction` is 0..1 of `stage`; `items` counts what the stage makes (voxels, triangles, bytes).
  using Report = std::function<void(std::string_view stage, double fraction, std::uint64_t items)>;

  Progress() = default;
  explicit Progress(Report report) : report_(std::move(report)) {}

  void report(std::string_view stage, double fraction, std::uint64_t items = 0) {
    if (!report_ || busy_.test_and_set(std::memory_order_acquire)) return;
    report_(stage, fraction, items);
    busy_.clear(std::memory_order_release);
  }

  /// Asks the work to stop; safe in a signal handler.
  void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const noexcept { return cancelled_.load(std::memory_order_relaxed); }
  void throw_if_cancelled() const {
    if (cancelled()) throw Cancelled();
  }

 private:
  Report report_;
  std::atomic<bool> cancelled_{false};
  std::atomic_flag busy_ = ATOMIC_FLAG_INIT;
};

}  // namespace voxdag
