#include "voxdag/formats/readers/chunks.hpp"

namespace voxdag {
namespace {

/// Returns where the line that holds byte `at` of the text ends, after its line end. Returns the
/// text's size if `at` is beyond it.
std::size_t end_of_line(std::string_view text, std::size_t at, char line_end) {
  for (std::size_t cut = at;; ++cut) {  // up to the first line end that ends its line
    cut = cut < text.size() ? text.find(line_end, cut) : text.npos;
    if (cut == text.npos) return text.size();
    std::size_t last = cut;
    if (last > 0 && text[last - 1] == '\r') --last;
    if (last == 0 || text[last - 1] != '\\') return cut + 1;
  }
}

}  // namespace

std::string_view LineChunks::operator[](std::size_t i) const {
  const std::size_t at = i * chunk_bytes, next = std::min(at + chunk_bytes, text.size());
  std::size_t begin = 0;
  if (i > 0) {
    // Looks no further than this chunk: a line may be as long as the file.
    const std::string_view known = text.substr(0, std::min(next + 1, text.size()));
    begin = end_of_line(known, at, line_end);
    if (begin > next || begin == text.size()) return text.substr(next, 0);
  }
  return text.substr(begin, end_of_line(text, next, line_end) - begin);
}

std::vector<std::string_view> LineChunks::all() const {
  std::vector<std::string_view> chunks(count());
  for (std::size_t i = 0; i < chunks.size(); ++i) chunks[i] = (*this)[i];
  return chunks;
}

void throw_fault(const MeshSource& source, const Fault& fault, char line_end) {
  if (line_end == kNoLines)
    throw source.error_at_byte(static_cast<std::size_t>(fault.position - source.bytes.data()),
                               fault.reason);
  const auto line = 1 + std::count(source.bytes.data(), fault.position, line_end);
  throw Error(source.name, ErrorPlace::line(line), fault.reason);
}

}  // namespace voxdag
