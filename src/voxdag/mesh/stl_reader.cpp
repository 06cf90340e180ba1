#include "voxdag/mesh/stl_reader.hpp"

#include "voxdag/mesh/chunks.hpp"
#include "voxdag/mesh/mesh_checks.hpp"
#include "voxdag/mesh/stl_text.hpp"
#include "voxdag/mesh/weld.hpp"

namespace voxdag {
namespace {

constexpr std::size_t kHeaderBytes = 84, kFacetBytes = 50;
constexpr std::size_t kMaxFacets = 0xFFFFFFFF / 3;

/// Number of facets that a binary file says it has; `bytes` hold a header.
std::uint32_t binary_facet_count(std::string_view bytes) {
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < 4; ++i)
    count |= std::uint32_t{static_cast<unsigned char>(bytes[80 + i])} << 8 * i;
  return count;
}

float load_float(const char* p) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i)
    bits |= std::uint32_t{static_cast<unsigned char>(p[i])} << 8 * i;
  return std::bit_cast<float>(bits);
}

class BinarySoup {
 public:
  explicit BinarySoup(const MeshBytes& source) : source_(source), starts_{0} {
    if (source.bytes.size() < kHeaderBytes)
      throw source.error("neither an ascii STL file nor long enough for a binary one");
    std::size_t left = binary_facet_count(source.bytes);
    const std::size_t room = (source.bytes.size() - kHeaderBytes) / kFacetBytes;
    if (left > room)
      throw source.error_at_byte(source.bytes.size(), "the file ends after " +
                                                          std::to_string(room) + " of " +
                                                          std::to_string(left) + " facets");
    if (left == 0) throw source.error("STL with 0 facets: there is no surface to read");
    if (left > kMaxFacets) throw source.error("more than 1,431,655,765 facets");
    for (std::size_t offset = kHeaderBytes; left > 0;) {
      const std::size_t count = std::min(left, kChunkBytes / kFacetBytes);
      parts_.push_back(source.bytes.substr(offset, count * kFacetBytes));
      starts_.push_back(starts_.back() + count);
      offset += count * kFacetBytes;
      left -= count;
    }
    for_each_chunk(source, parts_, kBinary, "scan", [this](std::size_t part) { check(part); });
  }

  const std::vector<std::size_t>& first_triangles() const { return starts_; }

  template <class Body>
  void visit(std::size_t part, const Body& body) const {
    const std::string_view facets = parts_[part];
    for (std::size_t facet = 0; facet < facets.size(); facet += kFacetBytes)
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const char* p = facets.data() + facet + 12 * (corner + 1);
        body(Vec3f{load_float(p), load_float(p + 4), load_float(p + 8)});
      }
    source_.done_with(facets, "weld");
  }

 private:
  void check(std::size_t part) const {
    std::size_t corner = 0;
    visit(part, [&](Vec3f position) {
      if (!is_finite(position))
        throw Fault{parts_[part].data() + corner / 3 * kFacetBytes + 12 * (corner % 3 + 1),
                    "vertex is not finite"};
      ++corner;
    });
  }

  const MeshBytes& source_;
  std::vector<std::string_view> parts_;
  std::vector<std::size_t> starts_;
};

class TextSoup {
 public:
  explicit TextSoup(const MeshBytes& source)
      : source_(source), parts_(split_facets(source.bytes)), starts_(parts_.size() + 1) {
    const char line_end = line_end_of(source.bytes);
    for_each_chunk(source, parts_, line_end, "scan", [this](std::size_t part) {
      std::size_t corners = 0;
      parse_stl_text(parts_[part], part == 0, part + 1 == parts_.size(), [&](Vec3f) { ++corners; });
      starts_[part + 1] = corners / 3;
    });
    for (std::size_t i = 0; i < parts_.size(); ++i) starts_[i + 1] += starts_[i];
    if (starts_.back() == 0) throw source.error("STL without facets: there is no surface to read");
    if (starts_.back() > kMaxFacets) throw source.error("more than 1,431,655,765 facets");
  }

  const std::vector<std::size_t>& first_triangles() const { return starts_; }

  template <class Body>
  void visit(std::size_t part, const Body& body) const {
    parse_stl_text(parts_[part], part == 0, part + 1 == parts_.size(), body);
    source_.done_with(parts_[part], "weld");
  }

 private:
  const MeshBytes& source_;
  const std::vector<std::string_view> parts_;
  std::vector<std::size_t> starts_;
};

}  // namespace

bool is_exact_binary_stl(std::string_view bytes) {
  if (bytes.size() < kHeaderBytes) return false;
  return bytes.size() == kHeaderBytes + kFacetBytes * std::uint64_t{binary_facet_count(bytes)};
}

bool is_ascii_stl(std::string_view bytes) {
  StlTokens tokens(without_byte_order_mark(bytes).substr(0, 4096));
  if (!same_word(tokens.next(), "solid")) return false;
  tokens.skip_line();
  const std::string_view word = tokens.next();
  return same_word(word, "facet") || same_word(word, "endsolid");
}

Mesh read_stl(const MeshBytes& source) {
  if (source.bytes.empty()) throw source.error("the file is empty");
  std::string_view head = without_byte_order_mark(source.bytes).substr(0, 4096);
  const bool starts_as_text = same_word(StlTokens(head).next(), "solid");
  if (starts_as_text && !is_exact_binary_stl(source.bytes)) return weld(TextSoup(source));
  return weld(BinarySoup(source));
}

}  // namespace voxdag
