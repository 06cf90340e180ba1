#pragma once
/// Measures wall-clock time.
#include <chrono>
#include <utility>

namespace voxdag::cli {

class Stopwatch {
 public:
  /// Returns the seconds since the last lap() or since construction, and starts a new lap.
  double lap() {
    const Clock::time_point before = std::exchange(start_, Clock::now());
    return std::chrono::duration<double>(start_ - before).count();
  }
  /// Returns the seconds since the last lap() or since construction.
  double since_start() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace voxdag::cli
