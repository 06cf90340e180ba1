#pragma once
/// Formats the numbers of the report's tables.
#include <fmt/core.h>

#include <cmath>
#include <string>

#include "voxdag/file/report/human.hpp"

namespace voxdag::lab {

/// Returns "–" for NaN, else three significant digits: "8.4 ms", "1.20 s", "95 s".
inline std::string seconds_text(double seconds) {
  if (std::isnan(seconds)) return "–";
  if (seconds < 0.0995) return fmt::format("{:.2g} ms", 1e3 * seconds);
  return seconds < 9.95 ? fmt::format("{:.2f} s", seconds) : fmt::format("{:.0f} s", seconds);
}

/// Returns "–" for NaN, else two or more digits: "0.034", "1.2", "27", "13,169".
inline std::string number_text(double value) {
  if (std::isnan(value)) return "–";
  if (value >= 99.5) return with_commas(static_cast<std::uint64_t>(std::llround(value)));
  return value >= 9.95 ? fmt::format("{:.0f}", value) : fmt::format("{:.2g}", value);
}

/// Returns "12.3 M".
inline std::string count_text(double count) { return human_count(count); }

/// Returns "512³", "4K³".
inline std::string short_resolution(int levels) {
  return levels < 10 ? fmt::format("{}³", 1 << levels) : fmt::format("{}K³", 1 << (levels - 10));
}

}  // namespace voxdag::lab
