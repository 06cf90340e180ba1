#include "voxdag/readers/chunks.hpp"

namespace voxdag {

std::vector<std::string_view> split_lines(std::string_view text, char line_end,
                                          std::size_t chunk_bytes) {
  std::vector<std::string_view> chunks;
  chunks.reserve(text.size() / chunk_bytes + 1);
  while (!text.empty()) {
    std::size_t cut = chunk_bytes;
    for (;; ++cut) {  // up to the first line end that ends its line
      cut = cut < text.size() ? text.find(line_end, cut) : text.npos;
      if (cut == text.npos) break;
      std::size_t last = cut;
      if (last > 0 && text[last - 1] == '\r') --last;
      if (last == 0 || text[last - 1] != '\\') break;
    }
    const std::size_t size = cut == text.npos ? text.size() : cut + 1;
    chunks.push_back(text.substr(0, size));
    text.remove_prefix(size);
  }
  return chunks;
}

void throw_fault(const MeshSource& source, const Fault& fault, char line_end) {
  if (line_end == kBinary)
    throw source.error_at_byte(static_cast<std::size_t>(fault.position - source.bytes.data()),
                               fault.reason);
  const auto line = 1 + std::count(source.bytes.data(), fault.position, line_end);
  throw Error(source.name, ErrorPlace::line(line), fault.reason);
}

}  // namespace voxdag
