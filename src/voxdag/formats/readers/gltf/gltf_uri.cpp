#include "voxdag/formats/readers/gltf/gltf_uri.hpp"

#include "voxdag/core/io/base64.hpp"
#include "voxdag/formats/readers/mesh_source.hpp"

namespace voxdag {
namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
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
