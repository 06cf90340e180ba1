#include "voxdag/formats/readers/obj/mtl_map.hpp"

#include <algorithm>
#include <cmath>

#include "voxdag/core/lower_case.hpp"
#include "voxdag/formats/readers/text_scan.hpp"

namespace voxdag {
namespace {

bool take_switch(std::string_view& text) {
  const std::string value = lower_case(next_token(text));
  if (value != "on" && value != "off") throw MalformedMtl("-clamp takes on or off");
  return value == "on";
}

/// Returns whether a word is '-' and letters.
bool is_option(std::string_view word) {
  return word.size() > 1 && std::all_of(word.begin() + 1, word.end(),
                                        [](char c) { return (c >= 'a' && c <= 'z') || c == '_'; });
}

/// Takes the options at the start of the text, and returns the rest.
std::string_view take_options(std::string_view text, MtlMap& map, MtlText kind) {
  for (; text.starts_with('-'); text = trim(text)) {
    std::string_view rest = text;
    const std::string option = lower_case(next_token(rest));
    std::array<float, 3> ignored{};
    if (option == "-s")
      take_numbers(rest, map.scale, 1, "-s takes one to three finite numbers");
    else if (option == "-o")
      take_numbers(rest, map.offset, 1, "-o takes one to three finite numbers");
    else if (option == "-mm")
      take_numbers(rest, map.base_gain, 2, "-mm takes two finite numbers");
    else if (option == "-bm")
      take_numbers(rest, std::span(&map.bump, 1), 1, "-bm takes a finite number");
    else if (option == "-clamp")
      map.clamp = take_switch(rest);
    else if (option == "-t")
      take_numbers(rest, ignored);
    else if (option == "-boost" || option == "-texres")
      take_numbers(rest, std::span(ignored).first(1));
    else if (option == "-blendu" || option == "-blendv" || option == "-cc" ||
             option == "-imfchan" || option == "-type" ||
             (kind == MtlText::kPlain && is_option(option)))
      next_token(rest);
    else
      break;  // Not an option: a file whose name starts with a dash.
    text = rest;
  }
  return text;
}

}  // namespace

std::size_t take_numbers(std::string_view& text, std::span<float> numbers) {
  std::size_t count = 0;
  std::string_view rest = text;
  for (float number; count < numbers.size() && parse_float(next_token(rest), number); text = rest)
    numbers[count++] = number;
  return count;
}

bool all_finite(std::span<const float> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](float x) { return std::isfinite(x); });
}

void take_numbers(std::string_view& text, std::span<float> numbers, std::size_t least,
                  const char* expected) {
  const std::size_t count = take_numbers(text, numbers);
  if (count < least || !all_finite(numbers.first(count))) throw MalformedMtl(expected);
}

std::string_view without_mtl_comment(std::string_view text) {
  for (std::size_t at = 1; at < text.size(); ++at)
    if (text[at] == '#' && is_blank(text[at - 1]) &&
        (at + 1 == text.size() || text[at + 1] < '0' || text[at + 1] > '9'))
      return trim(text.substr(0, at));
  return text;
}

std::string_view plain_mtl_name(std::string_view name) {
  name = without_mtl_comment(name);
  if (name.size() > 1 && name.front() == '"' && name.back() == '"')
    name = name.substr(1, name.size() - 2);
  return name;
}

MtlMap parse_mtl_map(std::string_view text, MtlText kind) {
  MtlMap map;
  if (kind == MtlText::kPlain) text = without_mtl_comment(text);
  text = take_options(trim(text), map, kind);
  for (std::size_t at = text.find(" -"); at != text.npos; at = text.find(" -", at + 1)) try {
      MtlMap with_more = map;
      if (!take_options(trim(text.substr(at)), with_more, kind).empty()) continue;
      map = with_more;
      text = trim(text.substr(0, at));
    } catch (const MalformedMtl&) {  // The dash belongs to the name.
    }
  map.file = text;
  if (map.file.empty()) throw MalformedMtl("it names no file");
  return map;
}

}  // namespace voxdag
