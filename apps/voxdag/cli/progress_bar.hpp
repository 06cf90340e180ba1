#pragma once
/// The line on a terminal that tells how far long work is.
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace voxdag {

/// Draws on stderr, and only where stderr is a terminal. Calls come one at a time.
class ProgressBar {
 public:
  /// A bar that is not enabled draws nothing.
  void enable(bool wanted);
  /// `fraction` is 0..1 of the stage; `items` is what the stage has made so far.
  void update(std::string_view stage, double fraction, std::uint64_t items);
  /// Takes the line away, so that other output begins at the left.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  bool enabled_ = false;
  bool drawn_ = false;
  std::string stage_;
  Clock::time_point stage_start_, last_draw_;
};

/// The text of the bar: stage, bar, percentage, rate and time left.
/// `seconds` is the time that the stage has run.
std::string progress_line(std::string_view stage, double fraction, std::uint64_t items,
                          double seconds);

}  // namespace voxdag
