#include "frame_names.hpp"

#include <fmt/core.h>

#include <regex>

namespace voxdag {
namespace {

/// Before the number, its digits, behind it.
const std::regex kPattern("([^%]*)%(?:0([1-9]))?d([^%]*)");

}  // namespace

bool is_frame_pattern(const std::string& pattern) { return std::regex_match(pattern, kPattern); }

std::string frame_name(const std::string& pattern, int frame) {
  std::smatch parts;
  if (!std::regex_match(pattern, parts, kPattern)) return pattern;
  const int digits = parts[2].matched ? std::stoi(parts[2]) : 1;
  return fmt::format("{}{:0{}d}{}", parts[1].str(), frame, digits, parts[3].str());
}

}  // namespace voxdag
