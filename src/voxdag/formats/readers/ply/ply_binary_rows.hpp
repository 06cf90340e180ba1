#pragma once
/// Reads rows of vertices and faces of a binary PLY file.
#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "voxdag/formats/readers/ply/ply_layout.hpp"
#include "voxdag/formats/readers/ply/ply_rows.hpp"

namespace voxdag {

/// A run of rows of one element.
struct PlyRows {
  std::string_view bytes;
  std::size_t first = 0, count = 0;
};

/// Threads may read different rows at the same time. All functions throw Fault if the rows go
/// beyond their bytes, OverMemory and Cancelled.
class PlyBinaryRows {
 public:
  /// `body` must outlive the reader.
  explicit PlyBinaryRows(const PlyBody& body);

  /// Reads vertices, and passes their other values to the attributes. `vertices` has one for each
  /// row.
  void read_vertices(const PlyRows& rows, std::span<Vec3f> vertices) const;
  /// Reads faces. Throws Fault for vertices and materials that do not exist.
  void read_faces(const PlyRows& rows, PlyFaces& faces) const;

 private:
  /// A property's place and type.
  struct Column {
    Place place;
    PlyType type;
    int slot = -1;  ///< PlyRowValues::Slot; -1: the list `texcoord`. Only for values.
  };

  static Column column(const PlyElement& element, const RowLayout& layout, int property);
  static std::vector<Column> used_columns(const PlyElement& element, const RowLayout& layout,
                                          const PlyColumns& columns);
  void take_values(const std::vector<Column>& columns, const RowLayout& layout, std::size_t run,
                   const char* fixed, std::size_t items, PlyRowValues& values) const;

  const PlyBody& body_;
  const bool swap_;
  const RowLayout vertex_layout_, face_layout_;
  const std::array<Column, 3> axes_;
  const Column corners_;  ///< The list of a face's corners.
  std::optional<Column> material_;
  std::vector<Column> vertex_values_, face_values_;  ///< Of the appearance, if it is read.
};

}  // namespace voxdag
