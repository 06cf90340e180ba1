#pragma once
/// Pauses between polls that grow, so that a waiting process leaves the CPU to others.
#include <algorithm>
#include <chrono>
#include <thread>

namespace voxdag {

/// Gives the CPU away a few times, then sleeps, longer each time, up to `longest`.
class Backoff {
 public:
  using Duration = std::chrono::microseconds;

  explicit Backoff(Duration longest) : longest_(longest) {}

  void pause() {
    if (yields_ < kYields) {
      ++yields_;
      std::this_thread::yield();
      return;
    }
    std::this_thread::sleep_for(sleep_);
    sleep_ = std::min(sleep_ * 2, longest_);
  }
  /// Begins with short pauses again.
  void reset() {
    yields_ = 0;
    sleep_ = kShortest;
  }

 private:
  static constexpr int kYields = 32;
  static constexpr Duration kShortest{10};

  Duration longest_, sleep_ = kShortest;
  int yields_ = 0;
};

}  // namespace voxdag
