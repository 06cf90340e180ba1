/// Replaces cli/progress_bar.cpp: reports to Module.onProgress(stage, fraction) of the module's
/// maker.
#include "cli/progress_bar.hpp"

#include <emscripten.h>
#include <emscripten/threading.h>

#include <string>

EM_JS(void, report_progress, (const char* stage, double fraction), {
  if (Module['onProgress']) Module['onProgress'](UTF8ToString(stage), fraction);
});

namespace voxdag::cli {

constexpr std::chrono::milliseconds kReportInterval{50};

void ProgressBar::enable(bool wanted) { enabled_ = wanted; }

void ProgressBar::update(std::string_view stage, double fraction, std::uint64_t) {
  if (!enabled_ || !emscripten_is_main_runtime_thread()) return;  // Only its JavaScript has Module.
  const Clock::time_point now = Clock::now();
  if (stage == stage_ && now - last_draw_ < kReportInterval) return;
  stage_ = stage;
  last_draw_ = now;
  report_progress(stage_.c_str(), fraction);
}

void ProgressBar::clear() {}

}  // namespace voxdag::cli
