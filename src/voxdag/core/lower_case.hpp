#pragma once
/// Letters in lower case.
#include <algorithm>
#include <string>
#include <string_view>

namespace voxdag {

/// Returns the text with its letters A to Z in lower case.
inline std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return lower;
}

}  // namespace voxdag
