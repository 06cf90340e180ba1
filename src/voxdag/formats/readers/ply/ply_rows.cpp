#include "voxdag/formats/readers/ply/ply_rows.hpp"

#include <string>

#include "voxdag/core/checked_size.hpp"

namespace voxdag {
void resize_ply_vertices(const PlyBody& body, MemoryReservation& memory, Mesh& mesh) {
  memory.resize(body.source.options.counted(body.fields.vertex.count * sizeof(Vec3f)));
  mesh.vertices.resize(checked_size(body.fields.vertex.count));
  if (body.attributes != nullptr) body.attributes->resize_vertices(mesh.vertices.size());
}

void resize_ply_triangles(const PlyBody& body, std::size_t triangles, MemoryReservation& memory,
                          Mesh& mesh) {
  if (triangles == 0)
    throw body.source.error("no face has three corners or more: there is no surface to read");
  const bool has_materials = body.fields.material >= 0;
  std::uint64_t bytes =
      memory.bytes() +
      body.source.options.counted(triangles *
                                  (sizeof(Triangle) + (has_materials ? sizeof(std::uint32_t) : 0)));
  if (has_materials) {
    for (const std::string_view name : body.header.materials)
      bytes += sizeof(std::string) + name.size() + 1;
  }
  memory.resize(bytes);
  mesh.triangles.resize(triangles);
  if (has_materials) {
    mesh.materials.assign(body.header.materials.begin(), body.header.materials.end());
    mesh.triangle_materials.resize(triangles);
  }
  if (body.attributes != nullptr) body.attributes->resize_triangles(triangles);
}

PlyTriangles ply_triangles(Mesh& mesh, std::size_t first, std::size_t last) {
  PlyTriangles part{first, std::span(mesh.triangles).subspan(first, last - first), {}};
  if (!mesh.triangle_materials.empty())
    part.materials = std::span(mesh.triangle_materials).subspan(first, last - first);
  return part;
}

void throw_ply_index(std::int64_t index, std::uint64_t count, const char* item, const char* items,
                     const char* position) {
  throw Fault{position, std::string(item) + " index " + std::to_string(index) +
                            " is out of range: " + std::to_string(count) + " " + items};
}

void PlyFaces::finish_face_with_attributes(const char* position) {
  // The file's coordinates are two for each corner, or they are ignored.
  if (values.texcoord.size() != 2 * writer_.corners()) values.texcoord.clear();
  const Rgba16 color = body_.attributes->face_color(values);
  writer_.finish_face(position, [&](std::size_t t, const Triangle& corners) {
    write_material(t);
    body_.attributes->take_triangle(triangles_.first + t, corners, color, values.texcoord);
  });
  values.texcoord.clear();
}

}  // namespace voxdag
