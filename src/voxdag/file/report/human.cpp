#include "voxdag/file/report/human.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace voxdag {
namespace {

/// Returns three significant digits with the largest of `units` for which the value is at least 1.
std::string scaled(double value, double step, const char* const (&units)[6]) {
  int unit = 0;
  // 999.5 would be printed as 1000 with the smaller unit.
  while (unit < 5 && value >= step * 0.9995) {
    value /= step;
    ++unit;
  }
  const int decimals = unit == 0 || value >= 99.95 ? 0 : value >= 9.995 ? 1 : 2;
  return fmt::format("{:.{}f}{}", value, decimals, units[unit]);
}

}  // namespace

std::string with_commas(std::uint64_t value) {
  std::string text = std::to_string(value);
  for (std::size_t at = text.size(); at > 3;) text.insert(at -= 3, 1, ',');
  return text;
}

std::string human_bytes(std::uint64_t bytes) {
  return scaled(static_cast<double>(bytes), 1024, {" B", " KiB", " MiB", " GiB", " TiB", " PiB"});
}

std::string human_count(double count) {
  return scaled(count, 1000, {"", " k", " M", " G", " T", " P"});
}

std::string human_seconds(double seconds) {
  if (seconds < 60) return fmt::format("{:.2f} s", seconds);
  const long whole = std::lround(seconds);
  return fmt::format("{} min {:02} s", whole / 60, whole % 60);
}

std::string human_clock(double seconds) {
  const long whole = std::lround(std::min(seconds, 3.6e6));
  const long hours = whole / 3600, minutes = whole / 60 % 60;
  return hours > 0 ? fmt::format("{}:{:02}:{:02}", hours, minutes, whole % 60)
                   : fmt::format("{}:{:02}", minutes, whole % 60);
}

std::string human_duration(double seconds) {
  if (seconds < 59.5) return fmt::format("{:.0f} s", seconds);
  const double minutes = seconds / 60, hours = minutes / 60, days = hours / 24;
  if (minutes < 59.5) return fmt::format("{:.0f} min", minutes);
  if (hours < 10)
    return fmt::format("{} h {:02} min", std::lround(minutes) / 60, std::lround(minutes) % 60);
  if (hours < 47.5) return fmt::format("{:.0f} h", hours);
  return with_commas(static_cast<std::uint64_t>(std::min(days, 1e12) + 0.5)) + " days";
}

std::string human_ratio(double ratio) {
  return ratio < 99.95 ? fmt::format("{:.1f}", ratio)
                       : with_commas(static_cast<std::uint64_t>(std::llround(ratio)));
}

}  // namespace voxdag
