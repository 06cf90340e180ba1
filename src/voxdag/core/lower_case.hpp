#pragma once
/// Letters in lower case.
#include <algorithm>
#include <string>

namespace voxdag {

/// Returns the text with its letters A to Z in lower case.
inline std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return text;
}

}  // namespace voxdag
