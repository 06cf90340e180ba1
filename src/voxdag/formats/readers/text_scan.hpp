#pragma once
/// Functions that parse text for OBJ, MTL, OFF, ascii PLY and ascii STL.
#include <fast_float/fast_float.h>

#include <charconv>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "voxdag/core/printable.hpp"

namespace voxdag {

inline bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

/// Removes the next run of non-blank characters from `line` and returns it; empty at the end.
inline std::string_view next_token(std::string_view& line) {
  const char* p = line.data();
  const char* const end = p + line.size();
  while (p != end && is_blank(*p)) ++p;
  const char* const first = p;
  while (p != end && !is_blank(*p)) ++p;
  line = {p, static_cast<std::size_t>(end - p)};
  return {first, static_cast<std::size_t>(p - first)};
}

inline std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Returns the end of a number that is not finite as Windows writes it, "1.#QNAN", "-1.#IND" or
/// "1.#INF00", whose '#' is at `sign`; null if the text is none.
inline const char* find_windows_nan_end(const char* first, const char* sign, const char* last) {
  if (sign - first < 2 || sign[-1] != '.' || sign[-2] != '1') return nullptr;
  const std::string_view rest(sign + 1, static_cast<std::size_t>(last - sign - 1));
  for (const std::string_view word : {"INF", "IND", "QNAN", "SNAN"})
    if (rest.starts_with(word)) {
      const char* end = sign + 1 + word.size();
      while (end != last && *end >= '0' && *end <= '9') ++end;
      return end;
    }
  return nullptr;
}

/// Parses the number that the text starts with into the nearest float or double (ties to even) and
/// returns the number's end, or null if the text does not start with a number. Accepts infinities
/// and NaN, also as Windows writes them (all as NaN); a number too large for the type becomes
/// infinite.
template <class Float>
const char* parse_float_prefix(const char* first, const char* last, Float& value) {
  if (first != last && *first == '+' && last - first > 1 && first[1] != '-') ++first;
  const auto result = fast_float::from_chars(first, last, value);
  if (result.ec == std::errc::invalid_argument) return nullptr;
  if (result.ptr != last && *result.ptr == '#')
    if (const char* const end = find_windows_nan_end(first, result.ptr, last)) {
      value = std::numeric_limits<Float>::quiet_NaN();
      return end;
    }
  return result.ptr;
}

/// Parses the whole token like parse_float_prefix(). Returns false if it is not a number.
template <class Float>
bool parse_float(std::string_view token, Float& value) {
  const char* const last = token.data() + token.size();
  return parse_float_prefix(token.data(), last, value) == last;
}

/// Parses a number like parse_float_prefix() and sets `value` to the float32 nearest to the number
/// less `origin`. The subtraction is in double.
inline const char* parse_coordinate_prefix(const char* first, const char* last, double origin,
                                           float& value) {
  if (origin == 0) return parse_float_prefix(first, last, value);
  double number = 0;
  const char* const end = parse_float_prefix(first, last, number);
  value = static_cast<float>(number - origin);
  return end;
}
/// Parses the whole token like parse_coordinate_prefix(). Returns false if it is not a number.
inline bool parse_coordinate(std::string_view token, double origin, float& value) {
  const char* const last = token.data() + token.size();
  return parse_coordinate_prefix(token.data(), last, origin, value) == last;
}

/// Parses the whole token as a decimal integer with or without a sign. Returns false if it is not
/// an integer.
inline bool parse_int(std::string_view token, std::int64_t& value) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-') token.remove_prefix(1);
  const char* const last = token.data() + token.size();
  const auto result = std::from_chars(token.data(), last, value);
  return result.ec == std::errc() && result.ptr == last;
}

/// Returns the character that ends lines: '\n', or '\r' if only '\r' occurs near the start.
inline char line_end_of(std::string_view text) {
  const std::string_view head = text.substr(0, 65536);
  return head.find('\n') == head.npos && head.find('\r') != head.npos ? '\r' : '\n';
}

inline std::string_view without_byte_order_mark(std::string_view text) {
  return text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text;
}

/// Returns whether a byte order mark of UTF-16 begins the text.
inline bool is_utf16(std::string_view text) {
  return text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF");
}

/// Removes the next line and its end from `text` and returns it without the end.
inline std::string_view next_line(std::string_view& text, char line_end) {
  const void* found = std::memchr(text.data(), line_end, text.size());
  const std::size_t size =
      found ? static_cast<std::size_t>(static_cast<const char*>(found) - text.data()) : text.size();
  const std::string_view line = text.substr(0, size);
  text.remove_prefix(found ? size + 1 : size);
  return line;
}

}  // namespace voxdag
