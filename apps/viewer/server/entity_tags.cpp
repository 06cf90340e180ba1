#include "viewer/server/entity_tags.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <span>

#include "voxdag/core/io/checksum.hpp"

namespace voxdag {

std::string quoted_tag(std::string_view tag) {
  std::string text = "\"";
  text.append(tag).append("\"");
  return text;
}

std::string tag_of(std::string_view bytes) {
  return quoted_tag(fmt::format("{:016x}", xxh3_64(std::as_bytes(std::span(bytes)))));
}

bool has_tag(std::string_view list, std::string_view tag) {
  while (!list.empty()) {
    const std::size_t comma = std::min(list.find(','), list.size());
    std::string_view item = list.substr(0, comma);
    list.remove_prefix(std::min(comma + 1, list.size()));
    while (!item.empty() && item.front() == ' ') item.remove_prefix(1);
    while (!item.empty() && item.back() == ' ') item.remove_suffix(1);
    if (item.starts_with("W/")) item.remove_prefix(2);
    if (item == tag || item == "*") return true;
  }
  return false;
}

}  // namespace voxdag
