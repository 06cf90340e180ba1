#include "voxdag/formats/readers/ply/ply_rows.hpp"

#include "voxdag/formats/readers/ply/ply_attributes.hpp"

namespace voxdag {

void resize_ply_vertices(const PlyBody& body, MemoryReservation& memory, Mesh& mesh) {
  memory.resize(body.source.options.counted(body.fields.vertex.count * sizeof(Vec3f)));
  mesh.vertices.resize(body.fields.vertex.count);
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

std::uint32_t checked_index(std::int64_t index, std::size_t vertices, const char* position) {
  if (index < 0 || static_cast<std::uint64_t>(index) >= vertices)
    throw Fault{position, "vertex index " + std::to_string(index) +
                              " is out of range: " + std::to_string(vertices) + " vertices"};
  return static_cast<std::uint32_t>(index);
}

std::uint32_t checked_material(std::int64_t index, std::size_t materials, const char* position) {
  if (index < 0 || static_cast<std::uint64_t>(index) >= materials)
    throw Fault{position, "material index " + std::to_string(index) +
                              " is out of range: " + std::to_string(materials) + " materials"};
  return static_cast<std::uint32_t>(index);
}

}  // namespace voxdag
