/// The binary body of a PLY file. Rows with lists have no fixed size, so one sequential pass finds
/// where blocks of rows start and how many triangles they make; the blocks are then read in
/// parallel.
#include <bit>

#include "voxdag/readers/ply/ply_layout.hpp"
#include "voxdag/readers/ply/ply_rows.hpp"

namespace voxdag {
namespace {

class BinaryReader {
 public:
  BinaryReader(const MeshBytes& source, const PlyHeader& header)
      : source_(source),
        header_(header),
        fields_(header),
        swap_((header.format == PlyFormat::kBigEndian) !=
              (std::endian::native == std::endian::big)),
        rest_(source.bytes.substr(header.body)) {}

  Mesh read() {
    mesh_.vertices.resize(fields_.vertex.count);
    std::size_t triangles = 0;
    for (const PlyElement& element : header_.elements) {
      const RowLayout layout(element);
      const std::vector<std::string_view> parts = split(element, layout);
      if (&element == &fields_.vertex) {
        vertex_parts_ = parts;
        vertex_blocks_ = blocks_;
      } else if (&element == &fields_.face) {
        face_parts_ = parts;
        for (PlyBlock& block : blocks_) {
          const std::size_t count = block.first_triangle;
          block.first_triangle = triangles;
          triangles += count;
        }
        face_blocks_ = blocks_;
      }
    }
    read_vertices();
    size_faces(source_, header_, fields_, triangles, mesh_);
    read_faces();
    if (not_finite_) check_finite();
    return std::move(mesh_);
  }

 private:
  /// Takes an element's rows off `rest_`, cut into blocks; fills `blocks_`, whose `first_triangle`
  /// is for now the number of triangles of the block.
  std::vector<std::string_view> split(const PlyElement& element, const RowLayout& layout) {
    std::vector<std::string_view> parts;
    blocks_.clear();
    try {
      layout.has_lists() ? split_lists(element, layout, parts)
                         : split_fixed(element, layout, parts);
    } catch (const Fault& fault) {
      throw_fault(source_, fault, kBinary);
    }
    return parts;
  }

  void split_fixed(const PlyElement& element, const RowLayout& layout,
                   std::vector<std::string_view>& parts) {
    const std::size_t stride = layout.fixed_row_bytes();
    if (stride == 0) return;
    if (element.count > rest_.size() / stride)
      throw Fault{rest_.data() + rest_.size(), "the file ends after " +
                                                   std::to_string(rest_.size() / stride) + " of " +
                                                   std::to_string(element.count) +
                                                   " rows of element " + in_quotes(element.name)};
    const std::size_t rows_per_block = std::max<std::size_t>(1, kChunkBytes / stride);
    for (std::size_t row = 0; row < element.count; row += rows_per_block) {
      const std::size_t rows = std::min<std::size_t>(rows_per_block, element.count - row);
      blocks_.push_back({row, rows, 0});
      parts.push_back(rest_.substr(0, rows * stride));
      rest_.remove_prefix(rows * stride);
    }
  }

  void split_lists(const PlyElement& element, const RowLayout& layout,
                   std::vector<std::string_view>& parts) {
    const char* const end = rest_.data() + rest_.size();
    const bool is_face = &element == &fields_.face;
    const std::size_t list_run =
        is_face ? layout.places[static_cast<std::size_t>(fields_.indices)].run : layout.runs.size();
    const char* p = rest_.data();
    for (std::size_t row = 0; row < element.count;) {
      PlyBlock block{row, 0, 0};
      const char* const start = p;
      for (; row < element.count && static_cast<std::size_t>(p - start) < kChunkBytes; ++row)
        p = layout.walk(p, end, swap_, [&](std::size_t run, const char*, std::size_t items) {
          if (run == list_run && items > 2) block.first_triangle += items - 2;
        });
      block.rows = row - block.first_row;
      blocks_.push_back(block);
      parts.emplace_back(start, static_cast<std::size_t>(p - start));
      source_.done_with(parts.back(), "scan");
    }
    rest_ = {p, static_cast<std::size_t>(end - p)};
  }

  void read_vertices() {
    const RowLayout layout(fields_.vertex);
    std::array<Place, 3> places;
    std::array<PlyType, 3> types;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto property = static_cast<std::size_t>(fields_.axes[axis]);
      places[axis] = layout.places[property];
      types[axis] = fields_.vertex.properties[property].type;
    }
    std::vector<char> bad(vertex_parts_.size(), 0);
    for_each_chunk(source_, vertex_parts_, kBinary, "read", [&](std::size_t i) {
      const char* p = vertex_parts_[i].data();
      const char* const end = p + vertex_parts_[i].size();
      const PlyBlock& block = vertex_blocks_[i];
      for (std::size_t row = 0; row < block.rows; ++row) {
        Vec3f& vertex = mesh_.vertices[block.first_row + row];
        p = layout.walk(p, end, swap_, [&](std::size_t run, const char* fixed, std::size_t) {
          for (std::size_t axis = 0; axis < 3; ++axis)
            if (places[axis].run == run)
              vertex[static_cast<int>(axis)] =
                  load_float(types[axis], fixed + places[axis].offset, swap_);
        });
        bad[i] |= !is_finite(vertex);
      }
    });
    not_finite_ = std::find(bad.begin(), bad.end(), 1) != bad.end();
  }

  void read_faces() {
    const RowLayout layout(fields_.face);
    const PlyProperty& list = fields_.face.properties[static_cast<std::size_t>(fields_.indices)];
    const std::size_t list_run = layout.places[static_cast<std::size_t>(fields_.indices)].run;
    const std::size_t list_skip = layout.runs[list_run].fixed_bytes + size_of(*list.count_type);
    const std::size_t item_bytes = size_of(list.type);
    const std::size_t vertices = mesh_.vertices.size();
    for_each_chunk(source_, face_parts_, kBinary, "read", [&](std::size_t i) {
      const char* p = face_parts_[i].data();
      const char* const end = p + face_parts_[i].size();
      std::size_t triangle = face_blocks_[i].first_triangle;
      for (std::size_t row = 0; row < face_blocks_[i].rows; ++row) {
        const std::size_t first_triangle = triangle;
        const char* const row_start = p;
        p = layout.walk(p, end, swap_, [&](std::size_t run, const char* fixed, std::size_t items) {
          if (run != list_run || items < 3) return;
          const char* item = fixed + list_skip;
          const auto next = [&] {
            const std::int64_t index = load_int(list.type, item, swap_);
            const std::uint32_t checked = checked_index(index, vertices, item);
            item += item_bytes;
            return checked;
          };
          const std::uint32_t first = next();
          std::uint32_t previous = next();
          for (std::size_t n = 2; n < items; ++n) {
            const std::uint32_t current = next();
            mesh_.triangles[triangle++] = {first, previous, current};
            previous = current;
          }
        });
        cut_face(mesh_, first_triangle, triangle);
        if (fields_.material >= 0) read_material(layout, row_start, end, first_triangle, triangle);
      }
    });
  }

  void read_material(const RowLayout& layout, const char* row, const char* end, std::size_t first,
                     std::size_t last) {
    const auto property = static_cast<std::size_t>(fields_.material);
    const Place place = layout.places[property];
    layout.walk(row, end, swap_, [&](std::size_t run, const char* fixed, std::size_t) {
      if (run != place.run) return;
      const char* const at = fixed + place.offset;
      const std::uint32_t material =
          checked_material(load_int(fields_.face.properties[property].type, at, swap_), mesh_, at);
      for (std::size_t t = first; t < last; ++t) mesh_.triangle_materials[t] = material;
    });
  }

  void check_finite() const {
    const std::int64_t index = find_bad_vertex(mesh_);
    if (index < 0) return;
    std::size_t i = vertex_blocks_.size() - 1;
    while (vertex_blocks_[i].first_row > static_cast<std::size_t>(index)) --i;
    const RowLayout layout(fields_.vertex);
    const char* p = vertex_parts_[i].data();
    const char* const end = p + vertex_parts_[i].size();
    for (auto row = vertex_blocks_[i].first_row; row < static_cast<std::size_t>(index); ++row)
      p = layout.walk(p, end, swap_, [](std::size_t, const char*, std::size_t) {});
    throw_fault(source_, {p, kBadVertex}, kBinary);
  }

  const MeshBytes& source_;
  const PlyHeader& header_;
  const PlyFields fields_;
  const bool swap_;
  std::string_view rest_;
  std::vector<PlyBlock> blocks_, vertex_blocks_, face_blocks_;
  std::vector<std::string_view> vertex_parts_, face_parts_;
  bool not_finite_ = false;
  Mesh mesh_;
};

}  // namespace

Mesh read_ply_binary(const MeshBytes& source, const PlyHeader& header) {
  return BinaryReader(source, header).read();
}

}  // namespace voxdag
