/// Reads the binary body of a PLY file. Rows with lists differ in size, so a sequential pass finds
/// the starts of blocks of rows and their numbers of triangles. Then threads read the blocks.
#include <bit>

#include "voxdag/formats/readers/ply/ply_attributes.hpp"
#include "voxdag/formats/readers/ply/ply_layout.hpp"
#include "voxdag/formats/readers/ply/ply_rows.hpp"

namespace voxdag {
namespace {

/// A run of rows of one element.
struct Block {
  std::string_view bytes;
  std::size_t first_row = 0, rows = 0;
  std::size_t first_triangle = 0;
};

/// Parts and blocks of an element's rows.
struct Blocks {
  std::vector<Block> blocks;
  std::vector<std::string_view> parts;  ///< The bytes of each block.
};

/// The destination of a property's values.
struct Column {
  int slot;  ///< PlyRowValues::Slot; -1: the list `texcoord`.
  PlyType type;
  Place place;
};

class BinaryReader {
 public:
  BinaryReader(const PlyBody& body, MemoryReservation& memory)
      : body_(body),
        source_(body.source),
        header_(body.header),
        fields_(body.fields),
        memory_(memory),
        swap_((header_.format == PlyFormat::kBigEndian) !=
              (std::endian::native == std::endian::big)),
        rest_(source_.bytes.substr(header_.body)),
        mesh_(empty_mesh(source_.options.arrays)) {}

  Mesh read() {
    std::size_t triangles = 0;
    for (const PlyElement& element : header_.elements) {
      Blocks blocks = split(element);
      if (&element == &fields_.vertex) vertices_ = std::move(blocks);
      if (&element == &fields_.face) faces_ = std::move(blocks);
    }
    for (Block& block : faces_.blocks) {
      const std::size_t count = block.first_triangle;
      block.first_triangle = triangles;
      triangles += count;
    }
    resize_ply_vertices(body_, memory_, mesh_);
    read_vertices();
    source_.end_pass();
    resize_ply_triangles(body_, triangles, memory_, mesh_);
    read_faces();
    if (has_bad_vertex_) check_finite();
    return std::move(mesh_);
  }

 private:
  /// Removes an element's rows from `rest_` and divides them into blocks. In blocks of faces,
  /// `first_triangle` is the block's number of triangles at this stage.
  Blocks split(const PlyElement& element) {
    const RowLayout layout(element);
    Blocks blocks;
    try {
      layout.has_lists() ? split_lists(element, layout, blocks.blocks)
                         : split_fixed(element, layout, blocks.blocks);
    } catch (const Fault& fault) {
      throw_fault(source_, fault, kNoLines);
    }
    for (const Block& block : blocks.blocks) blocks.parts.push_back(block.bytes);
    return blocks;
  }

  void split_fixed(const PlyElement& element, const RowLayout& layout, std::vector<Block>& blocks) {
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
      blocks.push_back({rest_.substr(0, rows * stride), row, rows, 0});
      rest_.remove_prefix(rows * stride);
    }
  }

  void split_lists(const PlyElement& element, const RowLayout& layout, std::vector<Block>& blocks) {
    const char* const end = rest_.data() + rest_.size();
    const bool is_face = &element == &fields_.face;
    const std::size_t list_run =
        is_face ? layout.places[static_cast<std::size_t>(fields_.indices)].run : layout.runs.size();
    const char* p = rest_.data();
    for (std::size_t row = 0; row < element.count;) {
      Block block{{}, row, 0, 0};
      const char* const start = p;
      for (; row < element.count && static_cast<std::size_t>(p - start) < kChunkBytes; ++row)
        p = layout.walk(p, end, swap_, [&](std::size_t run, const char*, std::size_t items) {
          if (run == list_run && items > 2) block.first_triangle += items - 2;
        });
      block.rows = row - block.first_row;
      block.bytes = {start, static_cast<std::size_t>(p - start)};
      blocks.push_back(block);
      source_.done_with(block.bytes, "scan");
    }
    rest_ = {p, static_cast<std::size_t>(end - p)};
  }

  /// Returns the properties of an element that belong to the appearance; none if the appearance is
  /// not read.
  std::vector<Column> used_columns(const PlyElement& element, const RowLayout& layout,
                                   const PlyColumns& columns) const {
    std::vector<Column> used;
    for (std::size_t p = 0; p < columns.slots.size(); ++p)
      if (columns.slots[p] >= 0 || static_cast<int>(p) == columns.texcoord)
        used.push_back({columns.slots[p], element.properties[p].type, layout.places[p]});
    return used;
  }

  /// Stores the values of one run of a row.
  void take_values(const std::vector<Column>& columns, const RowLayout& layout, std::size_t run,
                   const char* fixed, std::size_t items, PlyRowValues& values) const {
    for (const Column& column : columns) {
      if (column.place.run != run) continue;
      const char* at = fixed + column.place.offset;
      if (column.slot >= 0) {
        values.scalars[static_cast<std::size_t>(column.slot)] = load_float(column.type, at, swap_);
        continue;
      }
      at += size_of(layout.runs[run].count_type);
      values.texcoord.resize(items);
      for (float& value : values.texcoord) {
        value = load_float(column.type, at, swap_);
        at += size_of(column.type);
      }
    }
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
    const bool has_values = body_.attributes != nullptr;
    std::vector<Column> columns;
    if (has_values)
      columns = used_columns(fields_.vertex, layout, body_.attributes->vertex_columns());
    std::vector<char> bad(vertices_.blocks.size(), 0);
    for_each_chunk(source_, vertices_.parts, kNoLines, "read", [&](std::size_t i) {
      const Block& block = vertices_.blocks[i];
      const char* p = block.bytes.data();
      const char* const end = p + block.bytes.size();
      PlyRowValues values(source_.work().memory);
      for (std::size_t row = 0; row < block.rows; ++row) {
        Vec3f& vertex = mesh_.vertices[block.first_row + row];
        p = layout.walk(p, end, swap_, [&](std::size_t run, const char* fixed, std::size_t items) {
          for (std::size_t axis = 0; axis < 3; ++axis)
            if (places[axis].run == run)
              vertex[static_cast<int>(axis)] =
                  load_float(types[axis], fixed + places[axis].offset, swap_);
          if (has_values) take_values(columns, layout, run, fixed, items, values);
        });
        bad[i] |= !is_finite(vertex);
        if (has_values) body_.attributes->take_vertex(block.first_row + row, values);
      }
    });
    has_bad_vertex_ = std::find(bad.begin(), bad.end(), 1) != bad.end();
  }

  void read_faces() {
    const RowLayout layout(fields_.face);
    const PlyProperty& list = fields_.face.properties[static_cast<std::size_t>(fields_.indices)];
    const std::size_t list_run = layout.places[static_cast<std::size_t>(fields_.indices)].run;
    const std::size_t list_skip = layout.runs[list_run].fixed_bytes + size_of(*list.count_type);
    const std::size_t item_bytes = size_of(list.type);
    const std::size_t vertices = mesh_.vertices.size();
    const bool has_values = body_.attributes != nullptr;
    std::vector<Column> columns;
    if (has_values) columns = used_columns(fields_.face, layout, body_.attributes->face_columns());
    for_each_chunk(source_, faces_.parts, kNoLines, "read", [&](std::size_t i) {
      const char* p = faces_.parts[i].data();
      const char* const end = p + faces_.parts[i].size();
      std::size_t triangle = faces_.blocks[i].first_triangle;
      PlyRowValues values(source_.work().memory);
      FaceCutter cutter(source_);
      CancelPoll poll(source_.work());
      for (std::size_t row = 0; row < faces_.blocks[i].rows; ++row) {
        const std::size_t first_triangle = triangle;
        const char* const row_start = p;
        p = layout.walk(p, end, swap_, [&](std::size_t run, const char* fixed, std::size_t items) {
          if (has_values) take_values(columns, layout, run, fixed, items, values);
          if (run != list_run || items < 3) return;
          const char* item = fixed + list_skip;
          const auto next = [&] {
            poll.step();
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
        const std::size_t count = triangle - first_triangle;
        const auto fan = std::span(mesh_.triangles).subspan(first_triangle, count);
        if (has_values) {
          cutter.cut_and_match(fan, mesh_.vertices);
          body_.attributes->take_face(first_triangle, count, values, cutter);
        } else {
          cutter.cut(fan, mesh_.vertices);
        }
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
      const std::uint32_t material = checked_material(
          load_int(fields_.face.properties[property].type, at, swap_), mesh_.materials.size(), at);
      for (std::size_t t = first; t < last; ++t) mesh_.triangle_materials[t] = material;
    });
  }

  void check_finite() const {
    const auto bad = find_bad_vertex(source_, mesh_);
    if (!bad) return;
    std::size_t i = vertices_.blocks.size() - 1;
    while (vertices_.blocks[i].first_row > *bad) --i;
    const RowLayout layout(fields_.vertex);
    const char* p = vertices_.parts[i].data();
    const char* const end = p + vertices_.parts[i].size();
    for (std::size_t row = vertices_.blocks[i].first_row; row < *bad; ++row)
      p = layout.walk(p, end, swap_, [](std::size_t, const char*, std::size_t) {});
    throw_fault(source_, {p, kBadVertex}, kNoLines);
  }

  const PlyBody& body_;
  const MeshSource& source_;
  const PlyHeader& header_;
  const PlyFields& fields_;
  MemoryReservation& memory_;
  const bool swap_;
  std::string_view rest_;
  Blocks vertices_, faces_;
  bool has_bad_vertex_ = false;
  Mesh mesh_;
};

}  // namespace

Mesh read_ply_binary(const PlyBody& body, MemoryReservation& memory) {
  return BinaryReader(body, memory).read();
}

}  // namespace voxdag
