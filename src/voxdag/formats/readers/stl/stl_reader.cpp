/// Corners of facets with equal bits become one vertex. A first pass counts the facets and
/// estimates the vertices from a sample, so that the arrays have their final size from the start. A
/// second pass reads a batch of parts at a time. Threads weld each part by itself. Then the
/// vertices of the parts, which are far fewer than the corners, are welded in order. A hash table
/// takes at most 0.27 times the size of the finished mesh.
#include "voxdag/formats/readers/stl/stl_reader.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/core/parallel/thread_count.hpp"
#include "voxdag/formats/readers/chunks.hpp"
#include "voxdag/formats/readers/plain_colors.hpp"
#include "voxdag/formats/readers/stl/stl_facets.hpp"
#include "voxdag/formats/readers/warnings.hpp"
#include "voxdag/mesh/vertex_table.hpp"

namespace voxdag {
namespace {

/// Welds the facets of a file that is divided into parts. `visit(part, body)` calls body(Vec3f) for
/// the corners of one part in order, three per facet, and throws Fault at bad input.
template <class Visit>
class Welder {
 public:
  Welder(const MeshSource& source, const std::vector<std::string_view>& parts, char line_end,
         const Visit& visit)
      : source_(source),
        parts_(parts),
        line_end_(line_end),
        visit_(visit),
        starts_(parts.size() + 1),
        memory_(source.work().memory, 0),
        mesh_(empty_mesh(source.options.arrays)) {}

  Mesh weld() {
    const std::size_t vertices = measure();
    const std::size_t facets = starts_.back();
    if (facets == 0) throw source_.error("STL without facets: there is no surface to read");
    if (facets > kMaxStlFacets) throw source_.error("the mesh has more than 1,431,655,765 facets");
    // A full table is slow. This one is full only if almost no corners are shared.
    const std::size_t slots = 64 + std::min(vertices * 8 / 5, (facets + vertices) / 5 * 4);
    memory_.resize(source_.options.counted(triangle_bytes() + vertices * sizeof(Vec3f) +
                                           slots * sizeof(std::uint32_t)));
    mesh_.triangles.resize(facets);
    VertexTable table(vertices, slots, source_.options.arrays);
    const std::size_t batch = 2 * thread_count();
    for (std::size_t first = 0; first < parts_.size(); first += batch)
      weld_parts(first, std::min(first + batch, parts_.size()), table);
    mesh_.vertices = table.take_vertices();
    return std::move(mesh_);
  }

 private:
  std::uint64_t triangle_bytes() const { return starts_.back() * sizeof(Triangle); }

  /// Counts the facets of the parts. Returns an estimate of the number of distinct vertices.
  std::size_t measure() {
    // One in so many vertices is in the sample, by hash: 16, and fewer in files over 1 GiB, so that
    // the sample stays small. A power of two.
    const std::uint64_t one_in =
        std::max<std::uint64_t>(16, std::bit_floor(source_.bytes.size() >> 26));
    MemoryBudget* const memory = source_.work().memory;
    std::vector<CountedVector<Vec3f>> samples(parts_.size(), CountedVector<Vec3f>(memory));
    for_each_chunk(source_, parts_, line_end_, "scan", [&](std::size_t part) {
      VertexTable sample;
      std::size_t corners = 0;
      visit_(part, [&](Vec3f position) {
        ++corners;
        if ((hash_bits(position) & (one_in - 1)) == 0) sample.find_or_add(position);
      });
      starts_[part + 1] = corners / 3;
      samples[part].assign(sample.vertices().begin(), sample.vertices().end());
    });
    VertexTable sample;
    MemoryReservation counted(memory, 0);
    for (std::size_t part = 0; part < parts_.size(); ++part) {
      starts_[part + 1] += starts_[part];
      counted.resize(sample.bytes_with(samples[part].size()));
      for (const Vec3f position : samples[part]) sample.find_or_add(position);
    }
    // The true number hardly ever exceeds the estimate by four standard deviations.
    const auto sampled = static_cast<double>(sample.vertices().size());
    const auto estimate = static_cast<std::size_t>(static_cast<double>(one_in) *
                                                   (sampled + 4 * std::sqrt(sampled) + 4));
    return std::min(estimate, 3 * starts_.back());
  }

  /// Welds the parts [first, last): each by itself, then their vertices in order.
  void weld_parts(std::size_t first, std::size_t last, VertexTable& table) {
    const auto part = [this](std::size_t i) {
      return parts_.begin() + static_cast<std::ptrdiff_t>(i);
    };
    // Each corner may need a vertex and a slot in the part's table; both arrays may double.
    const MemoryReservation scratch(
        source_.work().memory,
        3 * (starts_[last] - starts_[first]) * (2 * sizeof(Vec3f) + 5 * sizeof(std::uint32_t)));
    std::vector<StoredVector<Vec3f>> vertices(last - first);
    for_each_chunk(source_, {part(first), part(last)}, line_end_, "weld",
                   [&](std::size_t i) { vertices[i] = weld_alone(first + i); });
    // The numbers of the parts' vertices in the mesh.
    std::vector<std::vector<std::uint32_t>> numbers(last - first);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      memory_.resize(
          source_.options.counted(triangle_bytes() + table.bytes_with(vertices[i].size())));
      numbers[i].reserve(vertices[i].size());
      for (const Vec3f position : vertices[i]) numbers[i].push_back(table.find_or_add(position));
    }
    parallel_for(numbers.size(), [&](std::size_t i) {
      for (std::size_t t = starts_[first + i]; t < starts_[first + i + 1]; ++t)
        for (std::uint32_t& corner : mesh_.triangles[t]) corner = numbers[i][corner];
    });
  }

  /// Sets the triangles of a part to indices of its own vertices. Returns these vertices.
  StoredVector<Vec3f> weld_alone(std::size_t part) {
    VertexTable own;
    std::uint32_t* corner = mesh_.triangles.data()->data() + 3 * starts_[part];
    const std::uint32_t* const end = mesh_.triangles.data()->data() + 3 * starts_[part + 1];
    const Fault changed{parts_[part].data(), kFileChanged};
    visit_(part, [&](Vec3f position) {
      if (corner == end) throw changed;
      *corner++ = own.find_or_add(position);
    });
    if (corner != end) throw changed;
    return own.take_vertices();
  }

  const MeshSource& source_;
  const std::vector<std::string_view>& parts_;
  const char line_end_;
  const Visit& visit_;
  std::vector<std::size_t> starts_;  ///< The first facet of each part, and the number of all.
  MemoryReservation memory_;         ///< The arrays of the mesh, and the table.
  Mesh mesh_;
};

constexpr std::size_t kFacetsPerPart = 2048;  ///< About the number in a part of an ascii file.

/// Returns whether bytes may be whole facets: not only zeros, which pad files, and all corners
/// finite.
bool are_facets(std::string_view bytes) {
  if (bytes.find_first_not_of('\0') == bytes.npos) return false;
  for (std::size_t at = 0; at < bytes.size(); at += kStlFacetBytes)
    for (std::size_t word = 12; word < 48; word += 4)
      if (!std::isfinite(std::bit_cast<float>(load_stl_word(bytes.data() + at + word))))
        return false;
  return true;
}

/// Returns the facets of a binary file. Adds a warning if the size of the file does not match.
std::string_view find_facets(const MeshSource& source, std::vector<std::string>& warnings) {
  if (source.bytes.size() < kStlHeaderBytes)
    throw source.error("not an STL file: it is not ASCII STL, and it is too short for binary STL");
  std::size_t count = stl_facet_count(source.bytes);
  const std::string_view facets = source.bytes.substr(kStlHeaderBytes);
  const std::size_t room = facets.size() / kStlFacetBytes;
  const bool is_whole = room > 0 && room * kStlFacetBytes == facets.size();
  const bool is_unset = count == 0 || count == 0xFFFFFFFF;  // Written before the facets were known.
  if (is_whole &&
      (is_unset || (count < room && are_facets(facets.substr(count * kStlFacetBytes))))) {
    warnings.push_back(source.name + ": the header says " + counted(count, "facet") +
                       ", but the size of the file is that of " + std::to_string(room) +
                       ": all are read");
    count = room;
  }
  if (count > room && is_utf16(source.bytes))
    throw source.error("STL in UTF-16: save it as ASCII or UTF-8");
  if (count > room && source.bytes.substr(0, 512).find('\0') == source.bytes.npos)
    throw source.error("not an STL file: text that does not begin with 'solid' or 'facet'");
  if (count > room)
    throw source.error_at_byte(source.bytes.size(), "the file ends after " + std::to_string(room) +
                                                        " of " + std::to_string(count) + " facets");
  if (count == 0) throw source.error("STL with 0 facets: there is no surface to read");
  const std::size_t size = count * kStlFacetBytes;
  if (size < facets.size()) {
    const std::string_view rest = facets.substr(size);
    warnings.push_back(source.name + ": ignored " + counted(rest.size(), "byte") +
                       " after the last facet" +
                       (is_exact_binary_stl(rest)
                            ? ": another STL file of " + counted(stl_facet_count(rest), "facet")
                        : rest.size() >= kStlFacetBytes
                            ? ", room for " + counted(rest.size() / kStlFacetBytes, "more facet")
                            : ""));
  }
  return facets.substr(0, size);
}

/// Returns the facets of a binary file in parts.
std::vector<std::string_view> split_binary(std::string_view facets) {
  std::vector<std::string_view> parts;
  for (std::size_t at = 0; at < facets.size(); at += kFacetsPerPart * kStlFacetBytes)
    parts.push_back(facets.substr(at, kFacetsPerPart * kStlFacetBytes));
  return parts;
}

/// Reads the colours of the facets of a binary file. Adds none if it has none.
void read_colors(const MeshSource& source, std::string_view facets, Appearance& appearance) {
  constexpr std::string_view kMagics = "COLOR=";
  const std::size_t count = facets.size() / kStlFacetBytes;
  const auto word = [&](std::size_t facet) {
    const char* const p = facets.data() + (facet + 1) * kStlFacetBytes - 2;
    return static_cast<unsigned>(static_cast<unsigned char>(p[0]) | static_cast<unsigned char>(p[1])
                                                                        << 8);
  };
  unsigned bits = 0;  // All that facets set.
  for (std::size_t facet = 0; facet < count; ++facet) bits |= word(facet);
  const std::size_t at = source.bytes.substr(0, 80).find(kMagics);
  const bool is_magics = at != source.bytes.npos;
  if (!is_magics && (bits & 0x8000) == 0) return;
  Rgba16 other = to_rgba16(kDefaultColor, 1);
  if (is_magics) {
    const auto channel = [&](std::size_t i) {
      return static_cast<float>(static_cast<unsigned char>(source.bytes[at + kMagics.size() + i])) /
             255;
    };
    other = from_srgb({channel(0), channel(1), channel(2)});
  }
  const MemoryReservation counted(source.work().memory, 3 * count * sizeof(Rgba16));
  appearance.colors.resize(3 * count);
  parallel_for(count, 65536, [&](std::size_t facet) {
    const unsigned code = word(facet);
    const bool has_color = bits != 0 && (code & 0x8000) == (is_magics ? 0 : 0x8000);
    const auto channel = [&](unsigned bit) { return static_cast<float>(code >> bit & 31) / 31; };
    const Vec3f first_low{channel(0), channel(5), channel(10)};
    const Vec3f rgb = is_magics ? first_low : Vec3f{first_low.z, first_low.y, first_low.x};
    std::fill_n(appearance.colors.data() + 3 * facet, 3, has_color ? from_srgb(rgb) : other);
  });
}

/// Welds the corners of each chunk.
class StlMeshChunks final : public MeshChunks {
 public:
  StlMeshChunks(MappedFile file, const std::filesystem::path& path, const ReadOptions& options,
                std::size_t chunk_bytes)
      : MeshChunks(std::move(file), path, options),
        facets_(stl_facet_count(source().bytes)),
        chunks_(facets_ * kStlFacetBytes / chunk_bytes + 1) {}

  std::uint64_t count() const override { return chunks_; }

  std::optional<ChunkCounts> counts(std::uint64_t chunk) const override {
    VertexTable table;
    std::uint64_t corners = 0;
    for_each_corner(chunk, [&](Vec3f position) {
      table.find_or_add(position);
      ++corners;
    });
    return ChunkCounts{table.vertices().size(), corners / 3};
  }

  void read_vertices(std::uint64_t chunk, std::span<Vec3f> vertices) const override {
    VertexTable table;
    for_each_corner(chunk, [&](Vec3f position) { table.find_or_add(position); });
    if (table.vertices().size() != vertices.size()) throw source().error(kFileChanged);
    std::copy(table.vertices().begin(), table.vertices().end(), vertices.begin());
  }

  void read_triangles(std::uint64_t chunk, const AllVertices& vertices,
                      std::span<Triangle> triangles) const override {
    VertexTable table;
    std::size_t corner = 0;
    for_each_corner(chunk, [&](Vec3f position) {
      triangles[corner / 3][corner % 3] =
          static_cast<std::uint32_t>(vertices.before) + table.find_or_add(position);
      ++corner;
    });
  }

  bool repeats_vertices() const override { return true; }

 private:
  template <class Body>
  void for_each_corner(std::uint64_t chunk, const Body& body) const {
    const std::uint64_t first = first_item(chunk, facets_), last = first_item(chunk + 1, facets_);
    const std::string_view facets = source().bytes.substr(kStlHeaderBytes + first * kStlFacetBytes,
                                                          (last - first) * kStlFacetBytes);
    // The caller's table: each corner may need a vertex and a slot; both arrays may double.
    const MemoryReservation table(source().work().memory, 3 * (last - first) * 44);
    read(facets, kNoLines, [&] { parse_stl_binary(source(), facets, body); });
  }

  std::uint64_t facets_, chunks_;
};

}  // namespace

bool is_exact_binary_stl(std::string_view bytes) {
  if (bytes.size() < kStlHeaderBytes) return false;
  return bytes.size() == kStlHeaderBytes + kStlFacetBytes * std::uint64_t{stl_facet_count(bytes)};
}

bool is_ascii_stl(std::string_view bytes) {
  StlTokens tokens(without_byte_order_mark(bytes).substr(0, 4096));
  const std::string_view first = tokens.next();
  if (same_word(first, "facet")) return tokens.take("normal") || tokens.take("outer");
  if (!same_word(first, "solid")) return false;
  tokens.skip_name();
  const std::string_view word = tokens.next();
  return same_word(word, "facet") || same_word(word, "endsolid");
}

MeshWithAppearance read_stl(const MeshSource& source, ReadParts parts) {
  if (source.bytes.empty()) throw source.error("the file is empty");
  const bool has_appearance = parts == ReadParts::kMeshAndAppearance;
  MeshWithAppearance read;
  std::string_view text = source.bytes;
  while (text.ends_with('\0') || text.ends_with('\x1A')) text.remove_suffix(1);  // DOS ends.
  const std::string_view head = without_byte_order_mark(text).substr(0, 512);
  const std::string_view word = StlTokens(head).next();
  const bool starts_as_text =
      (same_word(word, "solid") || same_word(word, "facet")) && head.find('\0') == head.npos;
  if (starts_as_text && !is_exact_binary_stl(source.bytes)) {
    const std::vector<std::string_view> texts = split_facets(text, kChunkBytes / 2);
    std::vector<std::size_t> irregular(texts.size());
    const auto visit = [&](std::size_t i, const auto& body) {
      irregular[i] = parse_stl_text(source, texts[i], i == 0, i + 1 == texts.size(), body);
    };
    read.mesh = Welder(source, texts, line_end_of(source.bytes), visit).weld();
    const std::size_t words = std::accumulate(irregular.begin(), irregular.end(), std::size_t{0});
    if (words > 0)
      read.warnings.push_back(source.name + ": " + counted(words, "keyword") +
                              " missing, doubled or split: 'solid', 'endsolid', 'normal', "
                              "'endloop' or 'endfacet'");
  } else {
    const std::string_view facets = find_facets(source, read.warnings);
    const std::vector<std::string_view> texts = split_binary(facets);
    const auto visit = [&](std::size_t i, const auto& body) {
      parse_stl_binary(source, texts[i], body);
    };
    read.mesh = Welder(source, texts, kNoLines, visit).weld();
    if (has_appearance) read_colors(source, facets, read.appearance);
  }
  if (has_appearance) add_plain_materials(source, read);
  return read;
}

std::unique_ptr<MeshChunks> open_stl_chunks(MappedFile file, const std::filesystem::path& path,
                                            const ReadOptions& options, std::size_t chunk_bytes) {
  if (!is_exact_binary_stl(file.text())) return nullptr;
  const std::uint64_t facets = stl_facet_count(file.text());
  if (facets == 0 || facets > kMaxStlFacets) return nullptr;
  return std::make_unique<StlMeshChunks>(std::move(file), path, options, chunk_bytes);
}

}  // namespace voxdag
