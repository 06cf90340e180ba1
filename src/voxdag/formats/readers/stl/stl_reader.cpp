#include "voxdag/formats/readers/stl/stl_reader.hpp"

#include "voxdag/formats/readers/chunks.hpp"
#include "voxdag/formats/readers/stl/stl_binary.hpp"
#include "voxdag/formats/readers/stl/stl_text.hpp"
#include "voxdag/formats/readers/weld_soup.hpp"

namespace voxdag {
namespace {

constexpr std::size_t kFacetsPerPart = 2048;  ///< About the number in a part of an ascii file.

/// Returns the facets of a binary file in parts.
std::vector<std::string_view> split_binary(const MeshSource& source) {
  if (source.bytes.size() < kStlHeaderBytes)
    throw source.error("not an STL file: it is not ASCII STL, and it is too short for binary STL");
  std::size_t left = stl_facet_count(source.bytes);
  const std::size_t room = (source.bytes.size() - kStlHeaderBytes) / kStlFacetBytes;
  if (left > room)
    throw source.error_at_byte(source.bytes.size(), "the file ends after " + std::to_string(room) +
                                                        " of " + std::to_string(left) + " facets");
  if (left == 0) throw source.error("STL with 0 facets: there is no surface to read");
  std::vector<std::string_view> parts;
  for (std::size_t offset = kStlHeaderBytes; left > 0;) {
    const std::size_t count = std::min(left, kFacetsPerPart);
    parts.push_back(source.bytes.substr(offset, count * kStlFacetBytes));
    offset += count * kStlFacetBytes;
    left -= count;
  }
  return parts;
}

template <class Visit>
Mesh weld_facets(const MeshSource& source, const std::vector<std::string_view>& parts,
                 char line_end, const Visit& visit) {
  const SoupSize size = measure_soup(source, parts, line_end, visit);
  const std::size_t facets = size.first_triangles.back();
  if (facets == 0) throw source.error("STL without facets: there is no surface to read");
  if (facets > kMaxStlFacets) throw source.error("the mesh has more than 1,431,655,765 facets");
  return weld(source, parts, line_end, visit, size);
}

}  // namespace

bool is_exact_binary_stl(std::string_view bytes) {
  if (bytes.size() < kStlHeaderBytes) return false;
  return bytes.size() == kStlHeaderBytes + kStlFacetBytes * std::uint64_t{stl_facet_count(bytes)};
}

bool is_ascii_stl(std::string_view bytes) {
  StlTokens tokens(without_byte_order_mark(bytes).substr(0, 4096));
  if (!same_word(tokens.next(), "solid")) return false;
  tokens.skip_line();
  const std::string_view word = tokens.next();
  return same_word(word, "facet") || same_word(word, "endsolid");
}

Mesh read_stl(const MeshSource& source) {
  if (source.bytes.empty()) throw source.error("the file is empty");
  std::string_view head = without_byte_order_mark(source.bytes).substr(0, 4096);
  const bool starts_as_text = same_word(StlTokens(head).next(), "solid");
  if (starts_as_text && !is_exact_binary_stl(source.bytes)) {
    const std::vector<std::string_view> parts = split_facets(source.bytes, kChunkBytes / 2);
    return weld_facets(source, parts, line_end_of(source.bytes), [&](std::size_t i, auto&& body) {
      parse_stl_text(parts[i], i == 0, i + 1 == parts.size(), body);
    });
  }
  const std::vector<std::string_view> parts = split_binary(source);
  return weld_facets(source, parts, kNoLines,
                     [&](std::size_t i, auto&& body) { parse_stl_binary(parts[i], body); });
}

}  // namespace voxdag
