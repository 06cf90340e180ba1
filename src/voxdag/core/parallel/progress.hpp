#pragma once
/// Reports the progress of long work to its caller, and lets the caller cancel it.
#include <atomic>
#include <cstdint>
#include <functional>
#include <string_view>

#include "voxdag/core/error.hpp"

namespace voxdag {

/// Long operations take it in a Work. Any thread may report, but only one at a time.
class Progress {
 public:
  /// Callback. `fraction` (0 to 1) of `stage` is done; `items` counts the results of the stage
  /// (voxels, triangles, bytes).
  using Report = std::function<void(std::string_view stage, double fraction, std::uint64_t items)>;

  Progress() = default;
  explicit Progress(Report report) : report_(std::move(report)) {}
  /// Makes the progress of a step of longer work: it reports nothing, and is cancelled when `whole`
  /// is, which may be null.
  explicit Progress(const Progress* whole) : whole_(whole) {}

  /// Calls the callback, unless another thread is calling it.
  void report(std::string_view stage, double fraction, std::uint64_t items = 0) {
    if (!report_ || busy_.test_and_set(std::memory_order_acquire)) return;
    report_(stage, fraction, items);
    busy_.clear(std::memory_order_release);
  }

  /// Asks the work to stop. Async-signal-safe.
  void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const noexcept {
    return cancelled_.load(std::memory_order_relaxed) || (whole_ != nullptr && whole_->cancelled());
  }
  /// Throws Cancelled if cancel() was called.
  void throw_if_cancelled() const {
    if (cancelled()) throw_cancelled();
  }

 private:
  /// A function of its own, so that compilers inline the check, which loops call for each item.
  [[noreturn, gnu::cold, gnu::noinline]] static void throw_cancelled() { throw Cancelled(); }

  Report report_;
  const Progress* whole_ = nullptr;
  std::atomic<bool> cancelled_{false};
  std::atomic_flag busy_ = ATOMIC_FLAG_INIT;
};

}  // namespace voxdag
