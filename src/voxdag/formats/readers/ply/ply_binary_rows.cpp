#include "voxdag/formats/readers/ply/ply_binary_rows.hpp"

namespace voxdag {

PlyBinaryRows::PlyBinaryRows(const PlyBody& body)
    : body_(body),
      swap_(body.header.swaps_bytes()),
      vertex_layout_(body.fields.vertex),
      face_layout_(body.fields.face),
      axes_{column(body.fields.vertex, vertex_layout_, body.fields.axes[0]),
            column(body.fields.vertex, vertex_layout_, body.fields.axes[1]),
            column(body.fields.vertex, vertex_layout_, body.fields.axes[2])},
      corners_(column(body.fields.face, face_layout_, body.fields.indices)) {
  if (body.fields.material >= 0)
    material_ = column(body.fields.face, face_layout_, body.fields.material);
  if (body.attributes == nullptr) return;
  vertex_values_ =
      used_columns(body.fields.vertex, vertex_layout_, body.attributes->vertex_columns());
  face_values_ = used_columns(body.fields.face, face_layout_, body.attributes->face_columns());
}

void PlyBinaryRows::read_vertices(const PlyRows& rows, std::span<Vec3f> vertices) const {
  const char* p = rows.bytes.data();
  const char* const end = p + rows.bytes.size();
  PlyRowValues values(body_.source.work().memory);
  const bool has_values = body_.attributes != nullptr;
  Vec3d point;
  for (std::size_t row = 0; row < rows.count; ++row) {
    p = vertex_layout_.walk(
        p, end, swap_, [&](std::size_t run, const char* fixed, std::size_t items) {
          for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto& [place, type, slot] = axes_[axis];
            if (place.run == run)
              point[static_cast<int>(axis)] = load_double(type, fixed + place.offset, swap_);
          }
          if (has_values) take_values(vertex_values_, vertex_layout_, run, fixed, items, values);
        });
    vertices[row] = body_.source.vertex(point);
    if (has_values) body_.attributes->take_vertex(rows.first + row, values);
  }
}

void PlyBinaryRows::read_faces(const PlyRows& rows, PlyFaces& faces) const {
  const char* p = rows.bytes.data();
  const char* const end = p + rows.bytes.size();
  const std::size_t item_bytes = size_of(corners_.type);
  const bool has_values = body_.attributes != nullptr;
  for (std::size_t row = 0; row < rows.count; ++row) {
    const char* const start = p;
    p = face_layout_.walk(
        p, end, swap_, [&](std::size_t run, const char* fixed, std::size_t items) {
          if (has_values) take_values(face_values_, face_layout_, run, fixed, items, faces.values);
          if (material_ && run == material_->place.run) {
            const char* const at = fixed + material_->place.offset;
            faces.set_material(load_int(material_->type, at, swap_), at);
          }
          if (run != corners_.place.run || items < 3) return;
          const char* item = fixed + face_layout_.runs[run].list_offset();
          for (std::size_t n = 0; n < items; ++n, item += item_bytes)
            faces.add_index(load_int(corners_.type, item, swap_), item);
        });
    faces.finish_row(start);
  }
}

PlyBinaryRows::Column PlyBinaryRows::column(const PlyElement& element, const RowLayout& layout,
                                            int property) {
  const auto p = static_cast<std::size_t>(property);
  return {layout.places[p], element.properties[p].type};
}

/// Returns the properties of an element that belong to the appearance.
std::vector<PlyBinaryRows::Column> PlyBinaryRows::used_columns(const PlyElement& element,
                                                               const RowLayout& layout,
                                                               const PlyColumns& columns) {
  std::vector<Column> used;
  for (std::size_t p = 0; p < columns.slots.size(); ++p)
    if (columns.slots[p] >= 0 || static_cast<int>(p) == columns.texcoord)
      used.push_back({layout.places[p], element.properties[p].type, columns.slots[p]});
  return used;
}

/// Stores the values of one run of a row.
void PlyBinaryRows::take_values(const std::vector<Column>& columns, const RowLayout& layout,
                                std::size_t run, const char* fixed, std::size_t items,
                                PlyRowValues& values) const {
  for (const Column& column : columns) {
    if (column.place.run != run) continue;
    if (column.slot >= 0) {
      values.scalars[column.slot] = load_float(column.type, fixed + column.place.offset, swap_);
      continue;
    }
    const char* item = fixed + layout.runs[run].list_offset();
    values.texcoord.resize(items);
    for (float& value : values.texcoord) {
      value = load_float(column.type, item, swap_);
      item += size_of(column.type);
    }
  }
}

}  // namespace voxdag
