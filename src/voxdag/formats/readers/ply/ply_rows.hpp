#pragma once
/// The types and functions that the readers of ascii and binary PLY bodies share.
#include <array>
#include <string>

#include "voxdag/formats/readers/bad_vertex.hpp"
#include "voxdag/formats/readers/chunks.hpp"
#include "voxdag/formats/readers/ply/ply_header.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

class PlyAttributes;

/// Indices of the properties that belong to the mesh.
struct PlyFields {
  explicit PlyFields(const PlyHeader& header)
      : vertex(header.elements[static_cast<std::size_t>(header.vertex)]),
        face(header.elements[static_cast<std::size_t>(header.face)]),
        axes{vertex.find({"x"}), vertex.find({"y"}), vertex.find({"z"})},
        indices(face.find({"vertex_indices", "vertex_index"})),
        material(header.materials.empty() ? -1 : face.find({"material_index"})) {
    if (material >= 0) {
      const PlyProperty& property = face.properties[static_cast<std::size_t>(material)];
      if (property.count_type || !is_integer(property.type)) material = -1;
    }
  }

  const PlyElement& vertex;
  const PlyElement& face;
  std::array<int, 3> axes;
  int indices;
  int material;  ///< -1: the file has no materials.
};

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

/// Returns the index if it is in range, else throws Fault.
std::uint32_t checked_index(std::int64_t index, std::size_t vertices, const char* position);
std::uint32_t checked_material(std::int64_t index, std::size_t materials, const char* position);

}  // namespace voxdag
