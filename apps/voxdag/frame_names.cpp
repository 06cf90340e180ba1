#include "frame_names.hpp"

#include <fmt/core.h>

#include <iterator>
#include <regex>

namespace voxdag {
namespace {

/// Before the number, its digits, behind it.
const std::regex kPattern("([^%]*)%(?:0([1-9]))?d([^%]*)");

}  // namespace

bool is_frame_pattern(const std::string& pattern) { return std::regex_match(pattern, kPattern); }

std::string frame_pattern_fault(const std::string& text) {
  if (is_frame_pattern(text)) return "";
  static const std::regex kPlace("%(0[1-9])?d");
  const auto places = std::distance(std::sregex_iterator(text.begin(), text.end(), kPlace), {});
  if (places > 1) return fmt::format("has {} places for a number, not one", places);
  if (places == 1) return "has a % that is no place for a number, such as %04d";
  return "has no place for a number, such as %04d";
}

std::string frame_name(const std::string& pattern, int frame) {
  std::smatch parts;
  if (!std::regex_match(pattern, parts, kPattern)) return pattern;
  const int digits = parts[2].matched ? std::stoi(parts[2]) : 1;
  return fmt::format("{}{:0{}d}{}", parts[1].str(), frame, digits, parts[3].str());
}

}  // namespace voxdag
