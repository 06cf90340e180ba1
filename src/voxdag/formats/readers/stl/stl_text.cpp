#include "voxdag/formats/readers/stl/stl_text.hpp"

namespace voxdag {

std::vector<std::string_view> split_facets(std::string_view text, std::size_t chunk_bytes) {
  constexpr std::string_view kWord = "endfacet";
  std::vector<std::string_view> parts;
  parts.reserve(text.size() / chunk_bytes + 1);
  std::size_t start = 0;
  for (std::size_t cut = chunk_bytes; cut + kWord.size() < text.size(); ++cut)
    if (same_word(text.substr(cut, kWord.size()), kWord)) {
      cut += kWord.size();
      parts.push_back(text.substr(start, cut - start));
      start = cut;
      cut += chunk_bytes;
    }
  parts.push_back(text.substr(start));
  return parts;
}

}  // namespace voxdag
