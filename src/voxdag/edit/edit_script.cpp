#include "voxdag/edit/edit_script.hpp"

#include <charconv>
#include <string>
#include <vector>

#include "voxdag/core/number_text.hpp"
#include "voxdag/core/printable.hpp"

namespace voxdag {
namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") + 1 - first);
}

/// Cuts the text before the first comma off and returns it.
std::string_view next_field(std::string_view& rest) {
  const std::size_t comma = rest.find(',');
  const std::string_view field = trimmed(rest.substr(0, comma));
  rest = comma == rest.npos ? std::string_view() : rest.substr(comma + 1);
  return field;
}

std::uint32_t material_in(std::string_view text) {
  std::uint32_t material = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, material);
  if (error != std::errc{} || stop != end)
    throw Error(in_quotes(text) + " is no number of a material");
  return material;
}

}  // namespace

std::optional<EditStep> parse_edit_line(std::string_view line, const Grid& grid) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF", kMaterial = "material=";
  if (line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
  line = trimmed(line);
  if (line.empty() || line.front() == '#') return {};
  // A comma at the end begins an empty field: the field before it must not be the last.
  const bool ends_in_comma = line.back() == ',';
  const EditVerb verb = edit_verb(next_field(line));
  const std::string_view shape = takes_shape(verb) ? next_field(line) : std::string_view();
  edit_fields(verb, shape);
  std::vector<double> numbers;
  EditPaint paint;
  while (!line.empty()) {
    const std::string_view field = next_field(line);
    if (field.starts_with('#')) {
      if (paint.color) throw Error("the edit has two colours");
      paint.color = edit_color(field);
    } else if (field.starts_with(kMaterial)) {
      if (paint.material) throw Error("the edit has two materials");
      paint.material = material_in(field.substr(kMaterial.size()));
    } else if (paint.color || paint.material) {
      throw Error(in_quotes(field) + " follows the colour or material: numbers come first");
    } else if (const auto number = number_in(field)) {
      numbers.push_back(*number);
    } else {
      throw Error(in_quotes(field) + " is no number, no colour #rrggbb and no material=N");
    }
  }
  if (ends_in_comma) throw Error("the line ends in a comma");
  return make_edit_step(verb, shape, numbers, paint, grid);
}

}  // namespace voxdag
