/// Reads the body of an ascii PLY file, which has one row per line. One pass over chunks of lines
/// counts the rows, a second pass counts the triangles. Then all values are parsed into arrays of
/// their final size.
#include "voxdag/core/checked_size.hpp"
#include "voxdag/formats/readers/ply/ply_rows.hpp"
#include "voxdag/formats/readers/ply/ply_text_row.hpp"

namespace voxdag {
namespace {

std::int64_t to_int(std::string_view token) {
  std::int64_t value = 0;
  if (!parse_int(token, value))
    throw Fault{token.data(), "value " + in_quotes(token) + " is not an integer"};
  return value;
}

class AsciiReader {
 public:
  AsciiReader(const PlyBody& body, MemoryReservation& memory)
      : body_(body),
        source_(body.source),
        header_(body.header),
        fields_(body.fields),
        memory_(memory),
        texts_(LineChunks{source_.bytes.substr(header_.body), header_.line_end}.all()),
        first_rows_(texts_.size() + 1),
        first_triangles_(texts_.size() + 1),
        mesh_(empty_mesh(source_.options.arrays)),
        vertices_{0, fields_.vertex.count,
                  [this](std::uint32_t vertex) { return mesh_.vertices[vertex]; }} {}

  Mesh read() {
    count_rows();
    resize_ply_vertices(body_, memory_, mesh_);
    std::vector<std::size_t> triangles(texts_.size(), 0);
    for_each_row("scan", face_rows_, [&](Chunk& chunk, std::size_t, std::string_view row) {
      const std::size_t corners = count_corners(row, chunk.poll);
      if (header_.has_strips)
        triangles[chunk.index] += count_strips(row, chunk.poll);
      else if (corners > 2)
        triangles[chunk.index] += corners - 2;
    });
    for (std::size_t i = 0; i < texts_.size(); ++i)
      first_triangles_[i + 1] = first_triangles_[i] + triangles[i];
    resize_ply_triangles(body_, first_triangles_.back(), memory_, mesh_);
    for_each_row("read", vertex_rows_, [this](Chunk& chunk, std::size_t i, std::string_view row) {
      parse_vertex(chunk, i, row);
    });
    source_.end_pass();
    for_each_row("read", face_rows_, [this](Chunk& chunk, std::size_t, std::string_view row) {
      parse_face(chunk.faces, chunk.poll, row);
    });
    return std::move(mesh_);
  }

 private:
  /// Rows of the body that belong to one element.
  struct Rows {
    std::size_t first = 0, last = 0;
  };

  /// The state of a thread that parses a chunk.
  struct Chunk {
    std::size_t index;
    CancelPoll poll;
    PlyRowValues values;
    PlyFaces faces;
  };

  void count_rows() {
    for_each_chunk(source_, texts_, header_.line_end, "scan", [this](std::size_t i) {
      std::string_view text = texts_[i];
      while (!text.empty())
        if (!trim(next_line(text, header_.line_end)).empty()) ++first_rows_[i + 1];
    });
    for (std::size_t i = 0; i < texts_.size(); ++i) first_rows_[i + 1] += first_rows_[i];
    std::size_t row = 0;
    for (const PlyElement& element : header_.elements) {
      if (element.properties.empty()) continue;  // Without properties, rows have no lines.
      const Rows rows{row, checked_size(row + element.count)};
      if (rows.last > first_rows_.back())
        throw_fault(
            source_,
            {source_.bytes.data() + source_.bytes.size(),
             "the file ends after " + std::to_string(first_rows_.back() - row) + " of " +
                 std::to_string(element.count) + " rows of element " + in_quotes(element.name)},
            header_.line_end);
      if (&element == &fields_.vertex) vertex_rows_ = rows;
      if (&element == &fields_.face) face_rows_ = rows;
      row = rows.last;
    }
  }

  /// Calls body(chunk, index in the element, row) for the rows of one element; chunks are parallel.
  template <class Body>
  void for_each_row(std::string_view stage, Rows rows, const Body& body) {
    for_each_chunk(source_, texts_, header_.line_end, stage, [&](std::size_t i) {
      if (first_rows_[i + 1] <= rows.first || first_rows_[i] >= rows.last) return;
      std::string_view text = texts_[i];
      Chunk chunk{i, CancelPoll(source_.work()), PlyRowValues(source_.work().memory),
                  PlyFaces(body_, vertices_,
                           ply_triangles(mesh_, first_triangles_[i], first_triangles_[i + 1]))};
      for (std::size_t row = first_rows_[i]; row < rows.last && !text.empty();) {
        const std::string_view line = next_line(text, header_.line_end);
        if (trim(line).empty()) continue;
        if (row >= rows.first) body(chunk, row - rows.first, line);
        ++row;
      }
    });
  }

  std::size_t count_corners(std::string_view row, CancelPoll& poll) const {
    for (int p = 0; p < fields_.indices; ++p)
      take_ply_property(row, fields_.face.properties[p], poll, [](std::string_view) {});
    const char* const start = row.data();
    std::int64_t corners = 0;
    // A corner needs at least two characters, so a count that is too large for the line is refused
    // before it is summed.
    if (!parse_int(next_token(row), corners) || corners < 0 ||
        static_cast<std::uint64_t>(corners) > row.size() / 2 + 1)
      throw Fault{start, "the number of vertex indices is missing, or the row is too short for it"};
    return static_cast<std::size_t>(corners);
  }

  /// Returns the number of triangles of a row of strips.
  std::size_t count_strips(std::string_view row, CancelPoll& poll) const {
    PlyStrip strip;
    std::size_t triangles = 0;
    for (int p = 0; p <= fields_.indices; ++p)
      take_ply_property(row, fields_.face.properties[p], poll, [&](std::string_view token) {
        if (p == fields_.indices)
          strip.add(to_int(token), [&](std::int64_t, std::int64_t, std::int64_t) { ++triangles; });
      });
    return triangles;
  }

  /// Stores a value of the appearance. A malformed number counts as the number that it starts with,
  /// or as 0.
  static void take_value(const PlyColumns& columns, std::size_t property, std::string_view token,
                         PlyRowValues& values) {
    float value = 0;
    if (static_cast<int>(property) == columns.texcoord) {
      parse_float(token, value);
      values.texcoord.push_back(value);
    } else if (columns.slots[property] >= 0) {
      parse_float(token, value);
      values.scalars[columns.slots[property]] = value;
    }
  }

  void parse_vertex(Chunk& chunk, std::size_t index, std::string_view row) {
    const auto& properties = fields_.vertex.properties;
    const bool has_values = body_.attributes != nullptr;
    Vec3f vertex;
    for (std::size_t p = 0; p < properties.size(); ++p)
      take_ply_property(row, properties[p], chunk.poll, [&](std::string_view token) {
        for (int axis = 0; axis < 3; ++axis)
          if (fields_.axes[axis] == static_cast<int>(p) &&
              !parse_coordinate(token, source_.origin[axis], vertex[axis]))
            throw Fault{token.data(), "coordinate " + in_quotes(token) + " is not a number"};
        if (has_values) take_value(body_.attributes->vertex_columns(), p, token, chunk.values);
      });
    check_ply_row_end(row);
    mesh_.vertices[index] = vertex;
    if (has_values) body_.attributes->take_vertex(index, chunk.values);
  }

  void parse_face(PlyFaces& faces, CancelPoll& poll, std::string_view row) {
    const auto& properties = fields_.face.properties;
    const char* const start = row.data();
    for (std::size_t p = 0; p < properties.size(); ++p) {
      const int property = static_cast<int>(p);
      take_ply_property(row, properties[p], poll, [&](std::string_view token) {
        if (property == fields_.material) faces.set_material(to_int(token), token.data());
        if (body_.attributes != nullptr)
          take_value(body_.attributes->face_columns(), p, token, faces.values);
        if (property == fields_.indices) faces.add_index(to_int(token), token.data());
      });
    }
    check_ply_row_end(row);
    faces.finish_row(start);
  }

  const PlyBody& body_;
  const MeshSource& source_;
  const PlyHeader& header_;
  const PlyFields& fields_;
  MemoryReservation& memory_;
  const std::vector<std::string_view> texts_;
  std::vector<std::size_t> first_rows_, first_triangles_;  ///< Per chunk, and then the totals.
  Rows vertex_rows_, face_rows_;
  Mesh mesh_;
  const AllVertices vertices_;
};

}  // namespace

Mesh read_ply_ascii(const PlyBody& body, MemoryReservation& memory) {
  return AsciiReader(body, memory).read();
}

}  // namespace voxdag
