#pragma once
/// Finds x, y, z, r, g and b among the names of columns in texts of points.
#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/core/lower_case.hpp"
#include "voxdag/formats/imports/points/text_cells.hpp"
#include "voxdag/formats/readers/text_scan.hpp"

namespace voxdag {

inline constexpr std::size_t kCoordinates = 3, kPointValues = 6;  ///< Coordinates, then a colour.

/// Removes a text from the start or the end of a name, and what joins it to the rest.
inline void remove_word(std::string& name, std::string_view word) {
  if (name.size() <= word.size()) return;
  if (name.starts_with(word))
    name.erase(0, word.size());
  else if (name.ends_with(word))
    name.resize(name.size() - word.size());
  else
    return;
  name.erase(0, name.find_first_not_of(" _-."));
  name.resize(name.find_last_not_of(" _-.") + 1);
}

/// Returns which value the name of a column stands for; kPointValues for another one. Units in
/// brackets do not count: "X [m]", "Red (8-bit)".
inline std::size_t value_of_name(std::string_view name) {
  constexpr std::string_view kNames[][kPointValues] = {
      {"x", "y", "z", "r", "g", "b"},
      {"points:0", "points:1", "points:2", "red", "green", "blue"},
      {"points_0", "points_1", "points_2", "rgb:0", "rgb:1", "rgb:2"},
      {"", "", "", "r8", "g8", "b8"},
      {"", "", "", "rf", "gf", "bf"}};
  const auto find = [&](const std::string& plain) {
    for (const auto& names : kNames)
      for (std::size_t value = 0; value < kPointValues; ++value)
        if (!plain.empty() && plain == names[value]) return value;
    return kPointValues;
  };
  std::string lower = lower_case(trim(name.substr(0, name.find_first_of("[("))));
  for (const char* const word : {"coordinate", "coord.", "coord"}) remove_word(lower, word);
  const std::size_t value = find(lower);
  if (value < kPointValues) return value;
  for (const char* const word : {"diffuse", "color", "colour", "_"}) remove_word(lower, word);
  const std::size_t color = find(lower);
  return color < kCoordinates ? kPointValues : color;
}

/// Returns whether the name of a column says that it holds a colour, or a component of one. A
/// single letter may stand for something else.
inline bool is_color_name(std::string_view name) {
  const std::string lower = lower_case(name);
  const std::size_t value = value_of_name(name);
  return (value >= kCoordinates && value < kPointValues && name.size() > 1) ||
         lower.find("rgb") != lower.npos || lower.find("color") != lower.npos ||
         lower.find("colour") != lower.npos;
}

/// Returns the separator of a line of names; 0: see TextCells.
inline char separator_of_names(std::string_view line) {
  return find_separator(line, [](const auto&) { return true; });
}

/// Returns the names of columns. Between blanks, leaves out units: "x [m] y [m] z [m]".
inline std::vector<std::string_view> names_of(std::string_view line) {
  const char separator = separator_of_names(line);
  std::vector<std::string_view> names = cells_of(line, separator);
  bool is_unit = false;
  if (separator == 0)
    std::erase_if(names, [&](std::string_view name) {
      const bool is_inside = is_unit || name.starts_with('[') || name.starts_with('(');
      is_unit = is_inside && !name.ends_with(']') && !name.ends_with(')');
      return is_inside;
    });
  return names;
}

/// Returns whether the names of columns have x, y and z among them.
inline bool has_coordinate_names(const std::vector<std::string_view>& names) {
  std::array<bool, kPointValues + 1> found{};
  for (const std::string_view name : names) found[value_of_name(name)] = true;
  return found[0] && found[1] && found[2];
}

}  // namespace voxdag
