#include "voxdag/render/film/frame_names.hpp"

#include <fmt/core.h>

#include <optional>
#include <string_view>

namespace voxdag {
namespace {

/// A placeholder for a number: %d, or %0Nd with a digit N from 1 to 9.
struct Placeholder {
  std::size_t at, size;
  int digits;
};

std::optional<Placeholder> placeholder_at(std::string_view text, std::size_t at) {
  const std::string_view rest = text.substr(at);
  if (rest.starts_with("%d")) return Placeholder{at, 2, 1};
  if (rest.size() < 4 || !rest.starts_with("%0") || rest[2] < '1' || rest[2] > '9' ||
      rest[3] != 'd')
    return std::nullopt;
  return Placeholder{at, 4, rest[2] - '0'};
}

/// The numbers of placeholders and of other % in a text.
struct Percents {
  int places = 0, others = 0;  // placeholders, and other %
  Placeholder last{};
};

Percents percents_of(std::string_view text) {
  Percents found;
  for (std::size_t at = text.find('%'); at != text.npos; at = text.find('%', at + 1)) {
    const std::optional<Placeholder> place = placeholder_at(text, at);
    if (place) found.last = *place;
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
  if (places > 1)
    return fmt::format("has {} placeholders for the frame number; exactly one is allowed", places);
  if (places == 1) return "has a % that is not a placeholder such as %04d";
  return "has no placeholder for the frame number, such as %04d";
}

std::string frame_name(const std::string& pattern, int frame) {
  if (!is_frame_pattern(pattern)) return pattern;
  const Placeholder place = percents_of(pattern).last;
  return fmt::format("{}{:0{}d}{}", pattern.substr(0, place.at), frame, place.digits,
                     pattern.substr(place.at + place.size));
}

}  // namespace voxdag
