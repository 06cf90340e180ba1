#include "voxdag/formats/readers/gltf/gltf_uri.hpp"

#include <cstdint>

#include "voxdag/formats/readers/mesh_source.hpp"

namespace voxdag {
namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// Returns the value of a base64 digit, also of the URL-safe alphabet, or -1.
int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  if (c == '/' || c == '_') return 63;
  return -1;
}

/// Returns nothing if the text is not base64.
std::optional<std::string> decode_base64(std::string_view text, Work work) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::string out;
  out.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int count = 0;
  CancelPoll poll(work);
  for (const char c : text) {
    poll.step();
    const int digit = base64_digit(c);
    if (digit < 0) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count >= 8) {
      count -= 8;
      out += static_cast<char>(bits >> count & 0xFF);
    }
  }
  return out;
}

}  // namespace

std::string decode_percent(std::string_view uri, Work work) {
  std::string out;
  out.reserve(uri.size());
  CancelPoll poll(work);
  for (std::size_t i = 0; i < uri.size(); ++i) {
    poll.step();
    const bool is_escaped = uri[i] == '%' && i + 2 < uri.size() && hex_digit(uri[i + 1]) >= 0 &&
                            hex_digit(uri[i + 2]) >= 0;
    if (!is_escaped) {
      out += uri[i];
    } else {
      out += static_cast<char>(hex_digit(uri[i + 1]) * 16 + hex_digit(uri[i + 2]));
      i += 2;
    }
  }
  return out;
}

std::optional<DecodedUri> decode_data_uri(std::string_view uri, Work work) {
  const std::size_t comma = uri.find(',');
  if (!uri.starts_with("data:") || comma == uri.npos) return std::nullopt;
  const std::string_view data = uri.substr(comma + 1);
  const bool is_base64 = uri.substr(0, comma).ends_with(";base64");
  DecodedUri decoded{{work.memory, is_base64 ? data.size() / 4 * 3 + 3 : data.size()}, {}};
  if (!is_base64) {
    decoded.bytes = decode_percent(data, work);
    return decoded;
  }
  std::optional<std::string> bytes = decode_base64(data, work);
  if (!bytes) return std::nullopt;
  decoded.bytes = std::move(*bytes);
  return decoded;
}

}  // namespace voxdag
