#include "render/frame_names.hpp"

#include <fmt/core.h>

#include <optional>
#include <string_view>

namespace voxdag {
namespace {

/// A place for a number, %d or %0Nd with a digit N from 1 to 9.
struct Place {
  std::size_t at, size;
  int digits;
};

std::optional<Place> place_at(std::string_view text, std::size_t at) {
  const std::string_view rest = text.substr(at);
  if (rest.starts_with("%d")) return Place{at, 2, 1};
  if (rest.size() < 4 || !rest.starts_with("%0") || rest[2] < '1' || rest[2] > '9' ||
      rest[3] != 'd')
    return std::nullopt;
  return Place{at, 4, rest[2] - '0'};
}

/// What the % of a text are.
struct Percents {
  int places = 0, others = 0;
  Place place{};  ///< The last one.
};

Percents percents_of(std::string_view text) {
  Percents found;
  for (std::size_t at = text.find('%'); at != text.npos; at = text.find('%', at + 1)) {
    const std::optional<Place> place = place_at(text, at);
    if (place) found.place = *place;
    ++(place ? found.places : found.others);
  }
  return found;
}

}  // namespace

bool is_frame_pattern(const std::string& pattern) {
  const Percents found = percents_of(pattern);
  return found.places == 1 && found.others == 0;
}

std::string frame_pattern_fault(const std::string& text) {
  if (is_frame_pattern(text)) return "";
  const int places = percents_of(text).places;
  if (places > 1) return fmt::format("has {} places for a number, not one", places);
  if (places == 1) return "has a % that is no place for a number, such as %04d";
  return "has no place for a number, such as %04d";
}

std::string frame_name(const std::string& pattern, int frame) {
  if (!is_frame_pattern(pattern)) return pattern;
  const Place place = percents_of(pattern).place;
  return fmt::format("{}{:0{}d}{}", pattern.substr(0, place.at), frame, place.digits,
                     pattern.substr(place.at + place.size));
}

}  // namespace voxdag
