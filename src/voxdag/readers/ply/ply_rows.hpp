#pragma once
/// What the ascii and the binary reader of PLY bodies share.
#include <string>

#include "voxdag/mesh/mesh.hpp"
#include "voxdag/mesh/polygon.hpp"
#include "voxdag/readers/chunks.hpp"
#include "voxdag/readers/ply/ply_header.hpp"

namespace voxdag {

/// Places of the properties that make the mesh, among those of their element.
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

/// A run of rows of one element: consecutive bytes of the body.
struct PlyBlock {
  std::size_t first_row = 0, rows = 0;
  std::size_t first_triangle = 0;
};

/// Makes room for `triangles` triangles, or throws Error if there are none.
inline void size_faces(const MeshBytes& source, const PlyHeader& header, const PlyFields& fields,
                       std::size_t triangles, Mesh& mesh) {
  if (triangles == 0)
    throw source.error("no face has three corners or more: there is no surface to read");
  mesh.triangles.resize(triangles);
  if (fields.material < 0) return;
  mesh.materials = header.materials;
  mesh.triangle_materials.resize(triangles);
}

inline std::uint32_t checked_index(std::int64_t index, std::size_t vertices, const char* position) {
  if (index < 0 || static_cast<std::uint64_t>(index) >= vertices)
    throw Fault{position, "vertex index " + std::to_string(index) +
                              " is out of range: " + std::to_string(vertices) + " vertices"};
  return static_cast<std::uint32_t>(index);
}

inline std::uint32_t checked_material(std::int64_t index, const Mesh& mesh, const char* position) {
  if (index < 0 || static_cast<std::uint64_t>(index) >= mesh.materials.size())
    throw Fault{position, "material index " + std::to_string(index) + " is out of range: " +
                              std::to_string(mesh.materials.size()) + " materials"};
  return static_cast<std::uint32_t>(index);
}

/// Cuts the face whose fan is the triangles [first, last).
inline void cut_face(Mesh& mesh, std::size_t first, std::size_t last) {
  cut_polygon(std::span(mesh.triangles).subspan(first, last - first), mesh.vertices);
}

/// Index of a vertex that is not finite and that a triangle uses, or -1.
inline std::int64_t find_bad_vertex(const Mesh& mesh) {
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t index : triangle)
      if (!is_finite(mesh.vertices[index])) return index;
  return -1;
}

inline constexpr const char* kBadVertex = "vertex is not finite and a face uses it";

Mesh read_ply_ascii(const MeshBytes& source, const PlyHeader& header);
Mesh read_ply_binary(const MeshBytes& source, const PlyHeader& header);

}  // namespace voxdag
