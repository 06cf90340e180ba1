#pragma once
/// Makes text from files safe to print: one line, of limited length.
#include <string>
#include <string_view>

#include "voxdag/core/utf8.hpp"

namespace voxdag {

inline constexpr std::size_t kLongestName = 200;  ///< In bytes.

/// Returns the text with '?' for control characters and for bytes that are not UTF-8. After
/// `longest` bytes "..." replaces the rest.
inline std::string printable(std::string_view text, std::size_t longest = kLongestName) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const std::string_view rest = text.substr(i);
    const std::size_t bytes = utf8_character_bytes(rest);
    const auto first = static_cast<unsigned char>(rest[0]);
    const bool is_control =
        first < 32 || first == 127 ||
        (bytes == 2 && first == 0xC2 && static_cast<unsigned char>(rest[1]) < 0xA0);
    if (i + (bytes > 0 ? bytes : 1) > longest) return out + "...";
    if (bytes == 0 || is_control)
      out += '?';
    else
      out += rest.substr(0, bytes);
    i += bytes > 0 ? bytes : 1;
  }
  return out;
}

/// Returns the printable text in quotes, cut after `longest` bytes: for tokens that a reader did
/// not expect.
inline std::string in_quotes(std::string_view text, std::size_t longest = 40) {
  return std::string(1, '\'').append(printable(text, longest)).append(1, '\'');
}
/// Returns a name in quotes.
inline std::string name_in_quotes(std::string_view name) { return in_quotes(name, kLongestName); }

}  // namespace voxdag
