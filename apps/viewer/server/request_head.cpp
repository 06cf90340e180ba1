#include "viewer/server/request_head.hpp"

#include <algorithm>
#include <charconv>
#include <string>

#include "voxdag/core/lower_case.hpp"

namespace voxdag {
namespace {

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t') || byte == 0x7F;
}

/// Sets the bytes of a body, or refuses it.
void take_body(std::string_view length, const ServerLimits& limits, RequestHead& head) {
  const char* const end = length.data() + length.size();
  const auto [stop, error] = std::from_chars(length.data(), end, head.body_bytes);
  if (stop == end && error == std::errc() && head.body_bytes <= limits.most_body_bytes) return;
  head = {stop == end && error != std::errc::invalid_argument ? 413 : 400, true};
}

}  // namespace

RequestHead check_head(std::string_view head, const ServerLimits& limits, bool takes_bodies) {
  RequestHead result;
  int fields = 0, hosts = 0, ranges = 0, lengths = 0;
  bool is_post = false, has_other_body = false;
  std::string_view body_length;
  std::size_t begin = 0;
  for (bool is_first = true;; is_first = false) {
    const std::size_t end = head.find("\r\n", begin);
    const std::string_view line = head.substr(begin, end - begin);
    if (line.empty() && !is_first) break;
    begin = end + 2;
    if (std::any_of(line.begin(), line.end(), is_control)) return {400, true};
    if (is_first) {
      const std::string_view method = line.substr(0, line.find(' '));
      result.may_have_body = method != "GET" && method != "HEAD";
      is_post = method == "POST";
      continue;
    }
    if (++fields > limits.most_fields) return {431, true};
    const std::size_t colon = line.find(':');
    // Programs disagree about a name with a space before its colon, and about a continued line.
    if (colon == 0 || colon == line.npos || line.substr(0, colon).find_first_of(" \t") != line.npos)
      return {400, true};
    const std::string name = lower_case(line.substr(0, colon));
    const std::string_view value = trimmed(line.substr(colon + 1));
    if (name == "host") ++hosts;
    if (name == "content-length") {
      ++lengths;
      body_length = value;
    }
    has_other_body |= name == "transfer-encoding" || name == "expect" || name == "upgrade";
    result.may_have_body |= has_other_body || (name == "content-length" && value != "0");
    if (name != "range") continue;
    if (++ranges > 1 || value.size() > limits.most_range_bytes ||
        std::count(value.begin(), value.end(), ',') >= limits.most_ranges)
      result.refusal = 416;
  }
  if (hosts > 1) return {400, true};
  if (takes_bodies && is_post && result.refusal == 0) {
    if (lengths != 1 || has_other_body) return {400, true};
    result.may_have_body = false;
    take_body(body_length, limits, result);
  }
  return result;
}

}  // namespace voxdag
