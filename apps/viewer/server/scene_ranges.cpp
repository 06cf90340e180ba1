#include "viewer/server/scene_ranges.hpp"

#include <algorithm>

namespace voxdag {

bool resolve_ranges(std::vector<ByteRange>& ranges, std::uint64_t size) {
  const auto end = static_cast<ssize_t>(size);
  std::uint64_t bytes = 0;
  std::vector<ByteRange> resolved;
  for (auto [first, last] : ranges) {
    if (first < 0 && last <= 0) continue;  // "-" and "-0"
    if (first < 0) {
      first = end - std::min(last, end);
      last = end - 1;
    }
    if (last < 0 || last >= end) last = end - 1;
    if (first > last) continue;
    bytes += static_cast<std::uint64_t>(last - first) + 1;
    if (bytes > size) return false;
    resolved.emplace_back(first, last);
  }
  ranges = std::move(resolved);
  return !ranges.empty();
}

}  // namespace voxdag
