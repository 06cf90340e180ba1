#pragma once
/// Texts that are compressed with LZF.
#include <cstdint>
#include <map>
#include <string>

namespace voxdag {

/// Compresses with the nearest earlier three bytes that are equal.
inline std::string lzf_of(const std::string& text) {
  std::string out, plain;
  const auto flush = [&] {
    for (std::size_t at = 0; at < plain.size(); at += 32) {
      const std::string part = plain.substr(at, 32);
      out += static_cast<char>(part.size() - 1);
      out += part;
    }
    plain.clear();
  };
  std::map<std::string, std::size_t> last;
  for (std::size_t at = 0; at < text.size();) {
    const std::string key = text.substr(at, 3);
    const auto found = last.find(key);
    std::size_t length = 0;
    const std::size_t back = found == last.end() ? SIZE_MAX : at - found->second;
    if (key.size() == 3 && back <= 8192)
      while (length < 264 && at + length < text.size() &&
             text[at + length - back] == text[at + length])
        ++length;
    last[key] = at;
    if (length < 3) {
      plain += text[at++];
      continue;
    }
    flush();
    const std::size_t high = (back - 1) >> 8, code = length - 2;
    out += static_cast<char>((code < 7 ? code : 7) << 5 | high);
    if (code >= 7) out += static_cast<char>(code - 7);
    out += static_cast<char>((back - 1) & 255);
    at += length;
  }
  flush();
  return out;
}

}  // namespace voxdag
