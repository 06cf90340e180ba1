#include "voxdag/formats/readers/stl/stl_mesh_chunks.hpp"

#include <algorithm>
#include <utility>

#include "voxdag/formats/readers/stl/stl_binary.hpp"
#include "voxdag/formats/readers/stl/stl_reader.hpp"
#include "voxdag/mesh/vertex_table.hpp"

namespace voxdag {
namespace {

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

  [[noreturn]] void throw_bad_vertex(std::uint64_t, std::uint64_t) const override {
    throw source().error("a vertex is not finite");  // for_each_corner() refuses these before
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
    read(facets, kNoLines, [&] { parse_stl_binary(facets, body); });
  }

  std::uint64_t facets_, chunks_;
};

}  // namespace

std::unique_ptr<MeshChunks> open_stl_chunks(MappedFile file, const std::filesystem::path& path,
                                            const ReadOptions& options, std::size_t chunk_bytes) {
  if (!is_exact_binary_stl(file.text())) return nullptr;
  const std::uint64_t facets = stl_facet_count(file.text());
  if (facets == 0 || facets > kMaxStlFacets) return nullptr;
  return std::make_unique<StlMeshChunks>(std::move(file), path, options, chunk_bytes);
}

}  // namespace voxdag
