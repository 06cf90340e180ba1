#include "viewer/server/multipart_body.hpp"

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

MultipartBody::MultipartBody(const SceneBytes& scene, const std::vector<ByteRange>& ranges,
                             const std::string& type, const std::string& boundary)
    : scene_(scene) {
  for (const auto& [first, last] : ranges)
    add((parts_.empty() ? "--" : "\r\n--") + boundary + "\r\nContent-Type: " + type +
            "\r\nContent-Range: bytes " + std::to_string(first) + "-" + std::to_string(last) + "/" +
            std::to_string(scene.size()) + "\r\n\r\n",
        static_cast<std::uint64_t>(first), static_cast<std::uint64_t>(last - first) + 1);
  add("\r\n--" + boundary + "--\r\n", 0, 0);
}

void MultipartBody::add(const std::string& text, std::uint64_t first, std::uint64_t bytes) {
  parts_.push_back({size_, text, first, bytes});
  size_ += text.size() + bytes;
}

bool MultipartBody::read(std::uint64_t offset, std::span<std::byte> out) const {
  for (const Part& part : parts_) {
    const std::uint64_t text = part.text.size(), size = text + part.bytes;
    if (out.empty()) return true;
    if (offset >= part.begin + size) continue;
    std::uint64_t at = offset - part.begin;
    if (at < text) {
      const std::size_t count = std::min<std::size_t>(out.size(), text - at);
      std::copy_n(std::as_bytes(std::span(part.text)).begin() + static_cast<std::ptrdiff_t>(at),
                  count, out.begin());
      out = out.subspan(count);
      offset += count;
      at += count;
    }
    const std::size_t count = std::min<std::size_t>(out.size(), size - at);
    if (count > 0 && !scene_.read(part.first + (at - text), out.first(count))) return false;
    out = out.subspan(count);
    offset += count;
  }
  return true;
}

}  // namespace voxdag
