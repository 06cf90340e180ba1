#pragma once
/// Formats numbers for people.
#include <cstdint>
#include <string>

namespace voxdag {

std::string with_commas(std::uint64_t value);  ///< 1234567 to "1,234,567".
std::string human_bytes(std::uint64_t bytes);  ///< Binary units: "12.3 MiB".
std::string human_count(double count);         ///< Decimal units: "12.3 M".
std::string human_seconds(double seconds);     ///< "0.35 s", "2 min 05 s".
std::string human_clock(double seconds);       ///< "0:07", "12:30", "1:02:03".
std::string human_duration(double seconds);    ///< "40 s", "12 min", "3 h 20 min", "12 days".
std::string human_ratio(double ratio);         ///< "33.4", "1,234".

}  // namespace voxdag
