#include "voxdag/formats/readers/chunks.hpp"

namespace voxdag {

std::vector<std::string_view> split_lines(std::string_view text, char line_end,
                                          std::size_t chunk_bytes) {
  std::vector<std::string_view> chunks;
  chunks.reserve(text.size() / chunk_bytes + 1);
  while (!text.empty()) {
    const std::size_t size = end_of_line(text, chunk_bytes, line_end);
    chunks.push_back(text.substr(0, size));
    text.remove_prefix(size);
  }
  return chunks;
}

std::size_t end_of_line(std::string_view text, std::size_t at, char line_end) {
  for (std::size_t cut = at;; ++cut) {  // up to the first line end that ends its line
    cut = cut < text.size() ? text.find(line_end, cut) : text.npos;
    if (cut == text.npos) return text.size();
    std::size_t last = cut;
    if (last > 0 && text[last - 1] == '\r') --last;
    if (last == 0 || text[last - 1] != '\\') return cut + 1;
  }
}

void throw_fault(const MeshSource& source, const Fault& fault, char line_end) {
  if (line_end == kNoLines)
    throw source.error_at_byte(static_cast<std::size_t>(fault.position - source.bytes.data()),
                               fault.reason);
  const auto line = 1 + std::count(source.bytes.data(), fault.position, line_end);
  throw Error(source.name, ErrorPlace::line(line), fault.reason);
}

}  // namespace voxdag
