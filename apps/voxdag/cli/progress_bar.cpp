#include "cli/progress_bar.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "voxdag/file/report/human.hpp"

namespace voxdag::cli {
namespace {

constexpr std::chrono::milliseconds kRedrawInterval{100};
constexpr int kBarColumns = 24;
/// The time left is shown after this fraction of a stage; before, the estimate is too inaccurate.
constexpr double kMinFraction = 0.02;

}  // namespace

std::string progress_line(std::string_view stage, double fraction, std::uint64_t items,
                          double seconds) {
  fraction = std::clamp(fraction, 0.0, 1.0);
  const int filled = static_cast<int>(fraction * kBarColumns);
  std::string line = fmt::format("{:<10} [{:#<{}}{:.<{}}] {:3.0f}%", stage, "", filled, "",
                                 kBarColumns - filled, std::floor(fraction * 100));
  if (seconds <= 0) return line;
  if (items > 0) line += fmt::format("  {}/s", human_count(static_cast<double>(items) / seconds));
  if (fraction >= kMinFraction)
    line += fmt::format("  {} left", human_clock(seconds * (1 - fraction) / fraction));
  return line;
}

void ProgressBar::enable(bool wanted) { enabled_ = wanted && isatty(STDERR_FILENO) == 1; }

void ProgressBar::update(std::string_view stage, double fraction, std::uint64_t items) {
  if (!enabled_) return;
  const Clock::time_point now = Clock::now();
  if (stage != stage_) {
    stage_ = stage;
    stage_start_ = now;
  } else if (now - last_draw_ < kRedrawInterval) {
    return;
  }
  last_draw_ = now;
  drawn_ = true;
  const double seconds = std::chrono::duration<double>(now - stage_start_).count();
  fmt::print(stderr, "\r{}\x1b[K", progress_line(stage, fraction, items, seconds));
  std::fflush(stderr);
}

void ProgressBar::clear() {
  if (drawn_) fmt::print(stderr, "\r\x1b[K");
  drawn_ = false;
}

}  // namespace voxdag::cli
