#include "voxdag/formats/readers/ply/ply_mesh_chunks.hpp"

#include <bit>
#include <utility>

#include "voxdag/formats/readers/ply/ply_layout.hpp"
#include "voxdag/formats/readers/ply/ply_rows.hpp"

namespace voxdag {
namespace {

/// Each chunk has its share of the vertices and its share of the faces.
class PlyMeshChunks final : public MeshChunks {
 public:
  PlyMeshChunks(MappedFile file, const std::filesystem::path& path, const ReadOptions& options,
                std::size_t chunk_bytes)
      : MeshChunks(std::move(file), path, options),
        header_(parse_ply_header(source())),
        fields_(header_),
        swap_((header_.format == PlyFormat::kBigEndian) !=
              (std::endian::native == std::endian::big)),
        vertex_layout_(fields_.vertex),
        face_layout_(fields_.face),
        is_readable_(find_rows()) {
    if (!is_readable_) return;
    const std::uint64_t bytes =
        fields_.vertex.count * vertex_stride_ + fields_.face.count * face_stride_;
    chunks_ = bytes / chunk_bytes + 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto property = static_cast<std::size_t>(fields_.axes[axis]);
      offsets_[axis] = vertex_layout_.places[property].offset;
      types_[axis] = fields_.vertex.properties[property].type;
    }
  }

  /// Returns whether rows have one size, if all faces are triangles.
  bool is_readable() const { return is_readable_; }

  std::uint64_t count() const override { return chunks_; }

  std::optional<ChunkCounts> counts(std::uint64_t chunk) const override {
    const Rows vertices = rows(chunk, fields_.vertex.count),
               faces = rows(chunk, fields_.face.count);
    const std::string_view bytes = face_bytes(faces);
    bool all_triangles = true;
    read(bytes, kNoLines, [&] {
      for (std::uint64_t i = 0; i < faces.count && all_triangles; ++i)
        all_triangles =
            load_int(count_type(), bytes.data() + i * face_stride_ + list_offset(), swap_) == 3;
    });
    if (!all_triangles) return std::nullopt;
    return ChunkCounts{vertices.count, faces.count};
  }

  void read_vertices(std::uint64_t chunk, std::span<Vec3f> vertices) const override {
    const std::string_view bytes = vertex_bytes(rows(chunk, fields_.vertex.count));
    read(bytes, kNoLines, [&] {
      const char* row = bytes.data();
      for (Vec3f& vertex : vertices) {
        for (std::size_t axis = 0; axis < 3; ++axis)
          vertex[static_cast<int>(axis)] = load_float(types_[axis], row + offsets_[axis], swap_);
        row += vertex_stride_;
      }
    });
  }

  void read_triangles(std::uint64_t chunk, const AllVertices& vertices,
                      std::span<Triangle> triangles) const override {
    const PlyType type = indices().type;
    const std::string_view bytes = face_bytes(rows(chunk, fields_.face.count));
    read(bytes, kNoLines, [&] {
      const char* row = bytes.data();
      for (Triangle& triangle : triangles) {
        const char* item = row + list_offset();
        if (load_int(count_type(), item, swap_) != 3) throw Fault{item, kFileChanged};
        item += size_of(count_type());
        for (std::uint32_t& corner : triangle) {
          corner = checked_index(load_int(type, item, swap_), vertices.count, item);
          item += size_of(type);
        }
        if (fields_.material >= 0) check_material(row);
        row += face_stride_;
      }
    });
  }

  [[noreturn]] void throw_bad_vertex(std::uint64_t chunk, std::uint64_t index) const override {
    const Rows vertices = rows(chunk, fields_.vertex.count);
    throw_fault(source(), {vertex_bytes({vertices.first + index, 1}).data(), kBadVertex}, kNoLines);
  }

 private:
  struct Rows {
    std::uint64_t first, count;
  };

  const PlyProperty& indices() const {
    return fields_.face.properties[static_cast<std::size_t>(fields_.indices)];
  }
  PlyType count_type() const { return *indices().count_type; }
  /// Returns where the number of corners lies in the row of a face.
  std::size_t list_offset() const { return face_layout_.runs[0].fixed_bytes; }

  /// Refuses a material that does not exist, as read_mesh() does. Throws Fault.
  void check_material(const char* row) const {
    const auto property = static_cast<std::size_t>(fields_.material);
    const Place place = face_layout_.places[property];
    const char* const at =
        row + place.offset +
        (place.run == 0 ? 0 : list_offset() + size_of(count_type()) + 3 * size_of(indices().type));
    checked_material(load_int(fields_.face.properties[property].type, at, swap_),
                     header_.materials.size(), at);
  }

  /// Finds the rows of vertices and faces. Returns whether all rows have one size.
  bool find_rows() {
    if (header_.format == PlyFormat::kAscii || fields_.face.count == 0) return false;
    // The layout of faces: fixed values, the list of indices, fixed values.
    if (vertex_layout_.has_lists() || face_layout_.runs.size() != 2) return false;
    vertex_stride_ = vertex_layout_.fixed_row_bytes();
    face_stride_ = face_layout_.runs[0].fixed_bytes + size_of(count_type()) +
                   3 * size_of(indices().type) + face_layout_.runs[1].fixed_bytes;
    std::uint64_t at = header_.body, faces_at = 0;
    for (const PlyElement& element : header_.elements) {
      if (&element == &fields_.face) {
        faces_at = at;
        at += element.count * face_stride_;
        continue;
      }
      const RowLayout layout(element);
      if (layout.has_lists()) return false;
      if (&element == &fields_.vertex) vertices_at_ = at;
      at += element.count * layout.fixed_row_bytes();
    }
    faces_at_ = faces_at;
    return at <= source().bytes.size();
  }

  Rows rows(std::uint64_t chunk, std::uint64_t count) const {
    const std::uint64_t first = first_item(chunk, count);
    return {first, first_item(chunk + 1, count) - first};
  }
  std::string_view vertex_bytes(const Rows& rows) const {
    return source().bytes.substr(vertices_at_ + rows.first * vertex_stride_,
                                 rows.count * vertex_stride_);
  }
  std::string_view face_bytes(const Rows& rows) const {
    return source().bytes.substr(faces_at_ + rows.first * face_stride_, rows.count * face_stride_);
  }

  PlyHeader header_;
  PlyFields fields_;
  bool swap_;
  RowLayout vertex_layout_, face_layout_;
  std::size_t vertex_stride_ = 0, face_stride_ = 0;
  std::uint64_t vertices_at_ = 0, faces_at_ = 0;  ///< Offsets of the first rows.
  bool is_readable_;
  std::uint64_t chunks_ = 0;
  std::array<std::size_t, 3> offsets_{};
  std::array<PlyType, 3> types_{};
};

}  // namespace

std::unique_ptr<MeshChunks> open_ply_chunks(MappedFile file, const std::filesystem::path& path,
                                            const ReadOptions& options, std::size_t chunk_bytes) {
  auto chunks = std::make_unique<PlyMeshChunks>(std::move(file), path, options, chunk_bytes);
  if (!chunks->is_readable()) return nullptr;
  return chunks;
}

}  // namespace voxdag
