/// The body of an ascii PLY file: one row per line. Chunks of lines are counted, so that each knows
/// which rows it holds; then triangles are counted; then everything is parsed into its place.
#include "voxdag/readers/ply/ply_rows.hpp"

namespace voxdag {
namespace {

/// Takes the values of one property off a row; calls on_item(token) for each.
template <class OnItem>
void take_property(std::string_view& row, const PlyProperty& property, const OnItem& on_item) {
  const auto token = [&] {
    const std::string_view text = next_token(row);
    if (text.empty())
      throw Fault{row.data(), "the row ends before property " + in_quotes(property.name)};
    return text;
  };
  std::int64_t items = 1;
  if (property.count_type) {
    const std::string_view count = token();
    if (!parse_int(count, items) || items < 0)
      throw Fault{row.data(), "list count " + in_quotes(count) + " is not a number of items"};
  }
  for (; items > 0; --items) on_item(token());
}

std::int64_t to_int(std::string_view token) {
  std::int64_t value = 0;
  if (!parse_int(token, value))
    throw Fault{token.data(), "value " + in_quotes(token) + " is not an integer"};
  return value;
}

class AsciiReader {
 public:
  AsciiReader(const MeshBytes& source, const PlyHeader& header)
      : source_(source),
        header_(header),
        fields_(header),
        texts_(split_lines(source.bytes.substr(header.body), header.line_end)),
        first_rows_(texts_.size() + 1),
        first_triangles_(texts_.size() + 1),
        not_finite_(texts_.size(), 0) {}

  Mesh read() {
    count_rows();
    mesh_.vertices.resize(fields_.vertex.count);
    for_each_row("scan", face_rows_, [this](std::size_t chunk, std::size_t, std::string_view row) {
      const std::size_t corners = count_corners(row);
      if (corners > 2) first_triangles_[chunk + 1] += corners - 2;
    });
    for (std::size_t i = 0; i < texts_.size(); ++i) first_triangles_[i + 1] += first_triangles_[i];
    size_faces(source_, header_, fields_, first_triangles_.back(), mesh_);
    for_each_row("read", vertex_rows_,
                 [this](std::size_t chunk, std::size_t i, std::string_view row) {
                   parse_vertex(chunk, i, row);
                 });
    std::vector<std::size_t> triangle(first_triangles_);
    for_each_row("read", face_rows_, [&](std::size_t chunk, std::size_t, std::string_view row) {
      triangle[chunk] = parse_face(row, triangle[chunk]);
    });
    check_finite();
    return std::move(mesh_);
  }

 private:
  /// Rows of the body that belong to one element.
  struct Rows {
    std::size_t first = 0, last = 0;
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
      if (element.properties.empty()) continue;  // Its rows have no lines.
      const Rows rows{row, row + element.count};
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

  /// Calls body(chunk, index in the element, row) for the rows of one element, chunks in parallel.
  template <class Body>
  void for_each_row(std::string_view stage, Rows rows, const Body& body) {
    for_each_chunk(source_, texts_, header_.line_end, stage, [&](std::size_t i) {
      if (first_rows_[i + 1] <= rows.first || first_rows_[i] >= rows.last) return;
      std::string_view text = texts_[i];
      for (std::size_t row = first_rows_[i]; row < rows.last && !text.empty();) {
        const std::string_view line = next_line(text, header_.line_end);
        if (trim(line).empty()) continue;
        if (row >= rows.first) body(i, row - rows.first, line);
        ++row;
      }
    });
  }

  std::size_t count_corners(std::string_view row) const {
    for (int p = 0; p < fields_.indices; ++p)
      take_property(row, fields_.face.properties[static_cast<std::size_t>(p)],
                    [](std::string_view) {});
    const char* const start = row.data();
    std::int64_t corners = 0;
    // A corner takes two characters at least, so a greater count is refused before it is summed.
    if (!parse_int(next_token(row), corners) || corners < 0 ||
        static_cast<std::uint64_t>(corners) > row.size() / 2 + 1)
      throw Fault{start, "the row has no list of vertex indices of the length that it says"};
    return static_cast<std::size_t>(corners);
  }

  void parse_vertex(std::size_t chunk, std::size_t index, std::string_view row) {
    const auto& properties = fields_.vertex.properties;
    Vec3f vertex;
    for (int p = 0; p < static_cast<int>(properties.size()); ++p)
      take_property(row, properties[static_cast<std::size_t>(p)], [&](std::string_view token) {
        for (int axis = 0; axis < 3; ++axis)
          if (fields_.axes[static_cast<std::size_t>(axis)] == p &&
              !parse_float(token, vertex[axis]))
            throw Fault{token.data(), "coordinate " + in_quotes(token) + " is not a number"};
      });
    check_row_end(row);
    if (!is_finite(vertex)) not_finite_[chunk] = 1;
    mesh_.vertices[index] = vertex;
  }

  /// Writes the triangles of one face from `triangle` on and returns the index after it.
  std::size_t parse_face(std::string_view row, std::size_t triangle) {
    const auto& properties = fields_.face.properties;
    const std::size_t first_triangle = triangle;
    std::uint32_t material = 0;
    for (int p = 0; p < static_cast<int>(properties.size()); ++p) {
      std::uint32_t first = 0, previous = 0;
      std::size_t corner = 0;
      take_property(row, properties[static_cast<std::size_t>(p)], [&](std::string_view token) {
        if (p == fields_.material) material = checked_material(to_int(token), mesh_, token.data());
        if (p != fields_.indices) return;
        const std::uint32_t index =
            checked_index(to_int(token), mesh_.vertices.size(), token.data());
        if (corner == 0) first = index;
        if (corner >= 2) mesh_.triangles[triangle++] = {first, previous, index};
        previous = index;
        ++corner;
      });
    }
    check_row_end(row);
    cut_face(mesh_, first_triangle, triangle);
    for (std::size_t t = first_triangle; t < triangle && fields_.material >= 0; ++t)
      mesh_.triangle_materials[t] = material;
    return triangle;
  }

  static void check_row_end(std::string_view row) {
    const std::string_view extra = next_token(row);
    if (!extra.empty())
      throw Fault{extra.data(),
                  "the row goes on with " + in_quotes(extra) + " after its last property"};
  }

  void check_finite() {
    if (std::find(not_finite_.begin(), not_finite_.end(), 1) == not_finite_.end()) return;
    const std::int64_t bad = find_bad_vertex(mesh_);
    if (bad < 0) return;
    for_each_row("read", vertex_rows_, [&](std::size_t, std::size_t i, std::string_view row) {
      if (i == static_cast<std::size_t>(bad)) throw Fault{row.data(), kBadVertex};
    });
  }

  const MeshBytes& source_;
  const PlyHeader& header_;
  const PlyFields fields_;
  const std::vector<std::string_view> texts_;
  std::vector<std::size_t> first_rows_, first_triangles_;
  std::vector<char> not_finite_;  ///< Per chunk.
  Rows vertex_rows_, face_rows_;
  Mesh mesh_;
};

}  // namespace

Mesh read_ply_ascii(const MeshBytes& source, const PlyHeader& header) {
  return AsciiReader(source, header).read();
}

}  // namespace voxdag
