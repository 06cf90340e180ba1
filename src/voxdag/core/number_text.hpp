#pragma once
/// Numbers in the texts of settings.
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

namespace voxdag {

/// Returns the shortest text that reads as this number.
inline std::string number_text(double number) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

/// Returns the value of a text that is a finite number, else nothing.
inline std::optional<double> number_in(std::string_view text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(number)) return {};
  return number;
}

}  // namespace voxdag
