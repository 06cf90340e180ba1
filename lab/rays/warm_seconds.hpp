#pragma once
/// Measures casts on a CUDA device with a high clock.
#include <chrono>
#include <functional>

namespace voxdag::lab {

/// Calls cast() repeatedly, at least once, and returns what the last call returned: its seconds. An
/// idle device has a low clock, which rises only under load: a device that was idle for a tenth of
/// a second gets 0.3 seconds of casts.
inline double warm_seconds(const std::function<double()>& cast) {
  using Clock = std::chrono::steady_clock;
  using std::chrono::milliseconds;
  static Clock::time_point last_end;
  const Clock::time_point start = Clock::now();
  const Clock::time_point warm =
      start + milliseconds(start - last_end > milliseconds(100) ? 300 : 20);
  double seconds = cast();
  while (Clock::now() < warm) seconds = cast();
  last_end = Clock::now();
  return seconds;
}

}  // namespace voxdag::lab
