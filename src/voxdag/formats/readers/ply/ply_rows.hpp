#pragma once
/// The types and functions that the readers of ascii and binary PLY bodies share.
#include <array>
#include <span>

#include "voxdag/formats/readers/chunks.hpp"
#include "voxdag/formats/readers/face_writer.hpp"
#include "voxdag/formats/readers/ply/ply_attributes.hpp"
#include "voxdag/formats/readers/ply/ply_header.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// The input of the reader of a body.
struct PlyBody {
  const MeshSource& source;
  const PlyHeader& header;
  const PlyFields& fields;
  PlyAttributes* attributes;  ///< Null: the appearance is not read.
};

/// Reads the mesh, and passes the rows' other values to body.attributes. `memory` counts the mesh.
/// Throws Error, OverMemory, Cancelled.
Mesh read_ply_ascii(const PlyBody& body, MemoryReservation& memory);
Mesh read_ply_binary(const PlyBody& body, MemoryReservation& memory);

/// Makes room for the vertices. Throws OverMemory.
void resize_ply_vertices(const PlyBody& body, MemoryReservation& memory, Mesh& mesh);
/// Makes room for `triangles` triangles. Throws Error if there are none, OverMemory.
void resize_ply_triangles(const PlyBody& body, std::size_t triangles, MemoryReservation& memory,
                          Mesh& mesh);

/// Throws the fault that an index of an item is out of range.
[[noreturn]] void throw_ply_index(std::int64_t index, std::uint64_t count, const char* item,
                                  const char* items, const char* position);

/// Returns the index of one of `count` items. Throws Fault if there is no such item.
inline std::uint32_t checked_ply_index(std::int64_t index, std::uint64_t count, const char* item,
                                       const char* items, const char* position) {
  // As an unsigned number, a negative index is greater than any count.
  if (static_cast<std::uint64_t>(index) >= count)
    throw_ply_index(index, count, item, items, position);
  return static_cast<std::uint32_t>(index);
}

/// Divides a triangle strip into triangles. A negative index starts a new strip.
struct PlyStrip {
  std::int64_t a = -1, b = -1;  ///< The last two indices.
  bool is_odd = false;

  /// Calls body(a, b, c) with the triangle that an index completes, unless two corners are equal:
  /// such triangles only join strips.
  template <class Body>
  void add(std::int64_t index, const Body& body) {
    if (index < 0) {
      *this = {};
      return;
    }
    if (a >= 0 && a != b && b != index && index != a)
      is_odd ? body(b, a, index) : body(a, b, index);
    is_odd = a >= 0 && !is_odd;
    a = b;
    b = index;
  }
};

/// The triangles that a run of faces becomes.
struct PlyTriangles {
  std::size_t first = 0;  ///< Index of the first one in the mesh.
  std::span<Triangle> triangles;
  std::span<std::uint32_t> materials;  ///< Of the triangles; empty: not wanted.
};

/// Returns the triangles [first, last) of a mesh.
PlyTriangles ply_triangles(Mesh& mesh, std::size_t first, std::size_t last);

/// Writes the triangles of faces, row by row, and passes their values to body.attributes.
class PlyFaces {
 public:
  /// `body` and `vertices` must outlive the faces.
  PlyFaces(const PlyBody& body, const AllVertices& vertices, const PlyTriangles& triangles)
      : values(body.source.work().memory),
        body_(body),
        vertices_(vertices),
        triangles_(triangles),
        writer_(body.source, vertices, triangles.triangles) {}

  PlyRowValues values;  ///< Of the row. The reader sets them.

  /// Adds an index of the row's face or strips. `position` is that of the index. Throws Fault if
  /// the vertex does not exist, OverMemory, Cancelled.
  void add_index(std::int64_t vertex, const char* position) {
    if (!body_.header.has_strips) return add_corner(vertex, position);
    strip_.add(vertex, [&](std::int64_t a, std::int64_t b, std::int64_t c) {
      for (const std::int64_t corner : {a, b, c}) add_corner(corner, position);
      finish_face(position);
    });
  }
  /// Throws Fault if the material does not exist.
  void set_material(std::int64_t material, const char* position) {
    const std::uint64_t count = body_.header.materials.size();
    if (body_.header.has_texture_numbers && static_cast<std::uint64_t>(material) >= count - 1) {
      if (body_.attributes != nullptr && material != -1) body_.attributes->count_bad_texture();
      material = static_cast<std::int64_t>(count) - 1;  // that without a texture
    }
    material_ = checked_ply_index(material, count, "material", "materials", position);
  }
  /// Writes the face's triangles and starts the next row. Throws as FaceWriter::finish_face() does.
  void finish_row(const char* position) {
    strip_ = {};
    finish_face(position);
  }
  /// Throws Error if some triangles are not written.
  void check_full() const { writer_.check_full(); }

 private:
  void add_corner(std::int64_t vertex, const char* position) {
    writer_.add_corner(checked_ply_index(vertex, vertices_.count, "vertex", "vertices", position));
  }
  void finish_face(const char* position) {
    if (body_.attributes != nullptr) return finish_face_with_attributes(position);
    writer_.finish_face(position, [this](std::size_t t, const Triangle&) { write_material(t); });
  }
  void finish_face_with_attributes(const char* position);
  void write_material(std::size_t triangle) {
    if (!triangles_.materials.empty()) triangles_.materials[triangle] = material_;
  }

  const PlyBody& body_;
  const AllVertices& vertices_;
  const PlyTriangles triangles_;
  FaceWriter writer_;
  PlyStrip strip_;
  std::uint32_t material_ = 0;
};

}  // namespace voxdag
