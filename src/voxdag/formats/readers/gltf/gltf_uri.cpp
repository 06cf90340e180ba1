#include "voxdag/formats/readers/gltf/gltf_uri.hpp"

#include <algorithm>
#include <iterator>

#include "voxdag/core/io/base64.hpp"
#include "voxdag/core/lower_case.hpp"
#include "voxdag/formats/readers/mesh_source.hpp"
#include "voxdag/formats/readers/text_scan.hpp"

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

bool is_data_uri(std::string_view uri) { return lower_case(uri.substr(0, 5)) == "data:"; }

std::optional<DecodedUri> decode_data_uri(std::string_view uri, Work work) {
  const std::size_t comma = uri.find(',');
  if (!is_data_uri(uri) || comma == uri.npos) return std::nullopt;
  std::string_view data = uri.substr(comma + 1), type = uri.substr(5, comma - 5);
  type = trim(type.substr(type.rfind(';') + 1));  // All of it if there is no semicolon.
  const bool is_base64 = lower_case(type.substr(0, 7)) == "base64";
  DecodedUri decoded{{work.memory, is_base64 ? data.size() / 4 * 3 + 3 : data.size()}, {}};
  if (!is_base64) {
    decoded.bytes = decode_percent(data, work);
    return decoded;
  }
  const auto is_gap = [](char c) { return c == '\n' || is_blank(c); };
  std::string lines;  // Without their ends.
  const bool has_gaps = std::any_of(data.begin(), data.end(), is_gap);
  const MemoryReservation counted(work.memory, has_gaps ? data.size() : 0);
  if (has_gaps) {
    std::remove_copy_if(data.begin(), data.end(), std::back_inserter(lines), is_gap);
    data = lines;
  }
  std::optional<std::string> bytes = decode_base64(data, work);
  if (!bytes) return std::nullopt;
  decoded.bytes = std::move(*bytes);
  return decoded;
}

}  // namespace voxdag
