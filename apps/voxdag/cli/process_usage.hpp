#pragma once
/// What this process takes.
#include <sys/resource.h>

#include <chrono>
#include <cstdint>
#include <utility>

namespace voxdag {

class Stopwatch {
 public:
  /// Seconds since the last lap, or since the beginning.
  double lap() {
    const Clock::time_point before = std::exchange(start_, Clock::now());
    return std::chrono::duration<double>(start_ - before).count();
  }
  /// Without a lap.
  double since_start() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// The most that was resident at any time.
inline std::uint64_t peak_memory_bytes() {
  struct rusage usage {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace voxdag
