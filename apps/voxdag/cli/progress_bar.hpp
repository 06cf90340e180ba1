#pragma once
/// A line on a terminal that shows the progress of long work.
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace voxdag::cli {

/// Draws on stderr, only if stderr is a terminal. Not thread-safe.
class ProgressBar {
 public:
  /// Turns the bar on if `wanted` and if stderr is a terminal. It is off at first.
  void enable(bool wanted);
  /// Draws the bar. `fraction` (0 to 1) of the stage is done; `items` counts its results so far.
  void update(std::string_view stage, double fraction, std::uint64_t items);
  /// Clears the line, so that other output starts in the first column.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  bool enabled_ = false;
  bool drawn_ = false;
  std::string stage_;
  Clock::time_point stage_start_, last_draw_;
};

/// Returns the text of the bar: stage, bar, percentage, rate and time left. `seconds` is the time
/// that the stage has run.
std::string progress_line(std::string_view stage, double fraction, std::uint64_t items,
                          double seconds);

}  // namespace voxdag::cli
