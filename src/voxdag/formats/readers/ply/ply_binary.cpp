/// Reads the binary body of a PLY file. Rows with lists differ in size, so a sequential pass finds
/// the starts of blocks of rows and their numbers of triangles. Then threads read the blocks. If
/// all faces are triangles, all rows have known places, and PlyMeshChunks needs no such pass.
#include "voxdag/core/checked_size.hpp"
#include "voxdag/formats/readers/ply/ply_binary_rows.hpp"
#include "voxdag/formats/readers/ply/ply_reader.hpp"

namespace voxdag {
namespace {

/// A run of rows of one element. Only faces have triangles.
struct Block {
  PlyRows rows;
  std::size_t first_triangle = 0, triangles = 0;
};

/// Blocks of an element's rows, and the bytes of each.
struct Blocks {
  std::vector<Block> blocks;
  std::vector<std::string_view> parts;
};

class BinaryReader {
 public:
  BinaryReader(const PlyBody& body, MemoryReservation& memory)
      : body_(body),
        source_(body.source),
        header_(body.header),
        fields_(body.fields),
        memory_(memory),
        rows_(body),
        rest_(source_.bytes.substr(header_.body)),
        mesh_(empty_mesh(source_.options.arrays)) {}

  Mesh read() {
    for (const PlyElement& element : header_.elements) {
      Blocks blocks = split(element);
      if (&element == &fields_.vertex) vertices_ = std::move(blocks);
      if (&element == &fields_.face) faces_ = std::move(blocks);
    }
    resize_ply_vertices(body_, memory_, mesh_);
    read_vertices();
    source_.end_pass();
    resize_ply_triangles(body_, place_triangles(), memory_, mesh_);
    read_faces();
    return std::move(mesh_);
  }

 private:
  /// Removes an element's rows from `rest_` and divides them into blocks.
  Blocks split(const PlyElement& element) {
    const RowLayout layout(element);
    Blocks blocks;
    try {
      layout.has_lists() ? split_lists(element, layout, blocks.blocks)
                         : split_fixed(element, layout, blocks.blocks);
    } catch (const Fault& fault) {
      throw_fault(source_, fault, kNoLines);
    }
    for (const Block& block : blocks.blocks) blocks.parts.push_back(block.rows.bytes);
    return blocks;
  }

  void split_fixed(const PlyElement& element, const RowLayout& layout, std::vector<Block>& blocks) {
    const std::size_t stride = layout.row_bytes(0);
    if (stride == 0) return;
    if (element.count > rest_.size() / stride)
      throw Fault{rest_.data() + rest_.size(), "the file ends after " +
                                                   std::to_string(rest_.size() / stride) + " of " +
                                                   std::to_string(element.count) +
                                                   " rows of element " + in_quotes(element.name)};
    const std::size_t rows_per_block = std::max<std::size_t>(1, kChunkBytes / stride);
    for (std::size_t row = 0; row < element.count; row += rows_per_block) {
      const std::size_t rows = std::min<std::size_t>(rows_per_block, element.count - row);
      blocks.push_back({{rest_.substr(0, rows * stride), row, rows}});
      rest_.remove_prefix(rows * stride);
    }
  }

  void split_lists(const PlyElement& element, const RowLayout& layout, std::vector<Block>& blocks) {
    const char* const end = rest_.data() + rest_.size();
    const bool is_face = &element == &fields_.face;
    const std::size_t corner_run =
        is_face ? layout.places[fields_.indices].run : layout.runs.size();
    const char* p = rest_.data();
    for (std::size_t row = 0; row < element.count;) {
      Block block{{{}, row, 0}};
      const char* const start = p;
      for (; row < element.count && static_cast<std::size_t>(p - start) < kChunkBytes; ++row)
        p = layout.walk(p, end, header_.swaps_bytes(),
                        [&](std::size_t run, const char* fixed, std::size_t items) {
                          if (run != corner_run) return;
                          if (header_.has_strips)
                            block.triangles +=
                                count_strips(fixed + layout.runs[run].list_offset(), items);
                          else if (items > 2)
                            block.triangles += items - 2;
                        });
      block.rows.count = row - block.rows.first;
      block.rows.bytes = {start, static_cast<std::size_t>(p - start)};
      blocks.push_back(block);
      source_.done_with(block.rows.bytes, "scan");
    }
    rest_ = {p, static_cast<std::size_t>(end - p)};
  }

  /// Returns the number of triangles of a list of strips.
  std::size_t count_strips(const char* indices, std::size_t count) const {
    const PlyType type = fields_.face.properties[fields_.indices].type;
    PlyStrip strip;
    std::size_t triangles = 0;
    for (std::size_t i = 0; i < count; ++i)
      strip.add(load_int(type, indices + i * size_of(type), header_.swaps_bytes()),
                [&](std::int64_t, std::int64_t, std::int64_t) { ++triangles; });
    return triangles;
  }

  /// Sets the blocks' first triangles. Returns the number of all triangles.
  std::size_t place_triangles() {
    std::size_t triangles = 0;
    for (Block& block : faces_.blocks) {
      block.first_triangle = triangles;
      triangles += block.triangles;
    }
    return triangles;
  }

  void read_vertices() {
    for_each_chunk(source_, vertices_.parts, kNoLines, "read", [&](std::size_t i) {
      const PlyRows& rows = vertices_.blocks[i].rows;
      rows_.read_vertices(rows, std::span(mesh_.vertices).subspan(rows.first, rows.count));
    });
  }

  void read_faces() {
    const AllVertices vertices{0, fields_.vertex.count,
                               [this](std::uint32_t vertex) { return mesh_.vertices[vertex]; }};
    for_each_chunk(source_, faces_.parts, kNoLines, "read", [&](std::size_t i) {
      const Block& block = faces_.blocks[i];
      PlyFaces faces(
          body_, vertices,
          ply_triangles(mesh_, block.first_triangle, block.first_triangle + block.triangles));
      rows_.read_faces(block.rows, faces);
    });
  }

  const PlyBody& body_;
  const MeshSource& source_;
  const PlyHeader& header_;
  const PlyFields& fields_;
  MemoryReservation& memory_;
  const PlyBinaryRows rows_;
  std::string_view rest_;
  Blocks vertices_, faces_;
  Mesh mesh_;
};

/// The rows of an element, if all have one size.
struct FixedRows {
  std::uint64_t at = 0;  ///< Offset of the first row in the file.
  std::uint64_t count = 0;
  std::size_t row_bytes = 0;

  PlyRows rows(std::string_view file, std::uint64_t first, std::uint64_t last) const {
    return {
        file.substr(checked_size(at + first * row_bytes), checked_size((last - first) * row_bytes)),
        checked_size(first), checked_size(last - first)};
  }
};

/// Each chunk has its share of the vertices and its share of the faces.
class PlyMeshChunks final : public MeshChunks {
 public:
  PlyMeshChunks(MappedFile file, const std::filesystem::path& path, const ReadOptions& options,
                std::size_t chunk_bytes)
      : MeshChunks(std::move(file), path, options),
        header_(parse_ply_header(source())),
        fields_(header_),
        rows_(body_),
        is_readable_(find_rows()),
        chunks_((vertices_.count * vertices_.row_bytes + faces_.count * faces_.row_bytes) /
                    chunk_bytes +
                1) {}

  /// Returns whether rows have one size, if all faces are triangles.
  bool is_readable() const { return is_readable_; }

  std::uint64_t count() const override { return chunks_; }

  std::optional<ChunkCounts> counts(std::uint64_t chunk) const override {
    const PlyRows faces = rows_of(chunk, faces_);
    const RowLayout layout(fields_.face);
    bool all_triangles = true;
    read(faces.bytes, kNoLines, [&] {
      const char* const first_list = faces.bytes.data() + layout.runs[0].fixed_bytes;
      for (std::uint64_t i = 0; i < faces.count && all_triangles; ++i)
        all_triangles = load_int(layout.runs[0].count_type, first_list + i * faces_.row_bytes,
                                 header_.swaps_bytes()) == 3;
    });
    if (!all_triangles) return std::nullopt;
    return ChunkCounts{rows_of(chunk, vertices_).count, faces.count};
  }

  void read_vertices(std::uint64_t chunk, std::span<Vec3f> vertices) const override {
    const PlyRows rows = rows_of(chunk, vertices_);
    read(rows.bytes, kNoLines, [&] { rows_.read_vertices(rows, vertices); });
  }

  void read_triangles(std::uint64_t chunk, const AllVertices& vertices,
                      std::span<Triangle> triangles) const override {
    const PlyRows rows = rows_of(chunk, faces_);
    read(rows.bytes, kNoLines, [&] {
      PlyFaces faces(body_, vertices, {0, triangles, {}});
      rows_.read_faces(rows, faces);
      faces.check_full();
    });
  }

 private:
  /// Finds the rows of vertices and faces. Returns false if rows of an element differ in size.
  bool find_rows() {
    if (header_.format == PlyFormat::kAscii || header_.has_strips) return false;
    std::uint64_t at = header_.body;
    for (const PlyElement& element : header_.elements) {
      const RowLayout layout(element);
      const bool is_face = &element == &fields_.face;
      // The only list that may be is that of a face's corners. It has three if counts() is right.
      if (layout.runs.size() != (is_face ? 2 : 1)) return false;
      const FixedRows rows{at, element.count, layout.row_bytes(3)};
      if (is_face) faces_ = rows;
      if (&element == &fields_.vertex) vertices_ = rows;
      at += rows.count * rows.row_bytes;
    }
    return at <= source().bytes.size();
  }

  PlyRows rows_of(std::uint64_t chunk, const FixedRows& element) const {
    return element.rows(source().bytes, first_item(chunk, element.count),
                        first_item(chunk + 1, element.count));
  }

  const PlyHeader header_;
  const PlyFields fields_;
  const PlyBody body_{source(), header_, fields_, nullptr};
  const PlyBinaryRows rows_;
  FixedRows vertices_, faces_;
  bool is_readable_;
  std::uint64_t chunks_;
};

}  // namespace

Mesh read_ply_binary(const PlyBody& body, MemoryReservation& memory) {
  return BinaryReader(body, memory).read();
}

std::unique_ptr<MeshChunks> open_ply_chunks(MappedFile file, const std::filesystem::path& path,
                                            const ReadOptions& options, std::size_t chunk_bytes) {
  auto chunks = std::make_unique<PlyMeshChunks>(std::move(file), path, options, chunk_bytes);
  if (!chunks->is_readable()) return nullptr;
  return chunks;
}

}  // namespace voxdag
