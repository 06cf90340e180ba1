#include "viewer/server/request_head.hpp"

#include <algorithm>
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

}  // namespace

RequestHead check_head(std::string_view head, const ServerLimits& limits) {
  RequestHead result;
  int fields = 0, hosts = 0, ranges = 0;
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
    if (name == "transfer-encoding" || (name == "content-length" && value != "0") ||
        name == "expect" || name == "upgrade")
      result.may_have_body = true;
    if (name != "range") continue;
    if (++ranges > 1 || value.size() > limits.most_range_bytes ||
        std::count(value.begin(), value.end(), ',') >= limits.most_ranges)
      result.refusal = 416;
  }
  if (hosts > 1) return {400, true};
  return result;
}

}  // namespace voxdag
