#include "cli/spelling.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace voxdag::cli {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kBritishAmerican = {
    {{"colour", "color"},
     {"grey", "gray"},
     {"centre", "center"},
     {"metre", "meter"},
     {"neighbour", "neighbor"}}};

/// Options of other programs, and the options here that do their work.
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kOtherPrograms = {
    {{"--width", "--size"}, {"--height", "--size"}, {"--turntable", "--path"}}};

std::string_view without_dashes(std::string_view word) {
  return word.substr(std::min(word.find_first_not_of('-'), word.size()));
}

/// Returns the optimal string alignment distance.
std::size_t edits_between(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] =
          std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

}  // namespace

std::string nearest_name(const std::string& word, const std::vector<std::string>& names) {
  for (const auto& [other, own] : kOtherPrograms)
    if (word == other && std::find(names.begin(), names.end(), own) != names.end())
      return std::string(own);
  const std::string_view asked = without_dashes(word);
  std::string nearest;
  std::size_t fewest = asked.size() / 3 + 1;
  for (const std::string& name : names) {
    const std::string_view known = without_dashes(name);
    const bool is_begun = asked.size() >= 3 && known.starts_with(asked);
    const std::size_t edits = is_begun ? 0 : edits_between(asked, known);
    if (edits < fewest) fewest = edits, nearest = name;
  }
  return nearest;
}

std::vector<std::string> other_spellings(const std::string& text) {
  const auto replaced = [&](bool to_american) {
    std::string result = text;
    for (const auto& [british, american] : kBritishAmerican) {
      const std::string_view from = to_american ? british : american,
                             to = to_american ? american : british;
      for (std::size_t at = 0; (at = result.find(from, at)) != result.npos; at += to.size())
        result.replace(at, from.size(), to);
    }
    return result;
  };
  return {replaced(true), replaced(false)};
}

}  // namespace voxdag::cli
