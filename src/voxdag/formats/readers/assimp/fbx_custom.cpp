#include "voxdag/formats/readers/assimp/fbx_custom.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "voxdag/formats/readers/text_scan.hpp"

namespace voxdag {
namespace {

/// Reads a value from the front; nothing if the bytes end before.
template <class T>
std::optional<T> take(std::string_view& bytes) {
  if (bytes.size() < sizeof(T)) return std::nullopt;
  T value{};
  std::memcpy(&value, bytes.data(), sizeof(T));
  bytes.remove_prefix(sizeof(T));
  return value;
}

/// Returns the number of a property, whose three other texts come before it, in binary FBX. A text
/// is 'S', its length and its bytes.
std::optional<double> binary_number(std::string_view bytes, const std::string& name) {
  std::string text(4, '\0');
  text[0] = static_cast<char>(name.size());
  const std::size_t at = bytes.find(text + name);
  if (at == bytes.npos) return std::nullopt;
  bytes.remove_prefix(at + text.size() + name.size());
  while (const auto type = take<char>(bytes)) {
    if (*type == 'I') return take<std::int32_t>(bytes);
    if (*type == 'D') return take<double>(bytes);
    const auto length = take<std::uint32_t>(bytes);
    if (*type != 'S' || !length || *length > bytes.size()) return std::nullopt;
    bytes.remove_prefix(*length);
  }
  return std::nullopt;
}

/// Returns the last number of the property's line in FBX text.
std::optional<double> text_number(std::string_view bytes, const std::string& name) {
  const std::size_t at = bytes.find('"' + name + '"');
  if (at == bytes.npos) return std::nullopt;
  std::string_view line = bytes.substr(at, bytes.find_first_of("\r\n", at) - at);
  line = trim(line.substr(line.rfind(',') + 1));
  double value = 0;
  return parse_float(line, value) ? std::optional(value) : std::nullopt;
}

}  // namespace

FormatCustom fbx_custom(std::string_view bytes) {
  const bool is_binary = bytes.starts_with("Kaydara FBX Binary");
  bytes = bytes.substr(0, 1 << 20);  // The settings come before the objects.
  const auto number = [&](const char* name, double otherwise) {
    return (is_binary ? binary_number(bytes, name) : text_number(bytes, name)).value_or(otherwise);
  };
  FormatCustom custom;
  custom.has_up = true;
  const double up = number("UpAxis", 1);
  if (up == 0 || up == 2) custom.up = static_cast<int>(up);
  const double centimetres = number("UnitScaleFactor", 1);
  constexpr std::pair<const char*, double> kUnits[] = {
      {"mm", 0.1}, {"cm", 1}, {"m", 100}, {"in", 2.54}, {"ft", 30.48}};
  for (const auto& [unit, size] : kUnits)
    if (std::fabs(centimetres - size) < 1e-6 * size) custom.unit = unit;
  return custom;
}

}  // namespace voxdag
