#include "voxdag/mesh/join_meshes.hpp"

#include <utility>

#include "voxdag/core/error.hpp"
#include "voxdag/mesh/mesh_memory.hpp"
#include "voxdag/mesh/place_vertices.hpp"

namespace voxdag {
namespace {

std::uint64_t all_bytes(const MeshWithAppearance& source) {
  return memory_bytes(source.mesh) + memory_bytes(source.appearance);
}

/// Appends values of corners. `corners` and `more` are the numbers of corners of both meshes.
template <class T>
void append_corners(std::vector<T>& to, std::vector<T>& from, std::size_t corners,
                    std::size_t more) {
  if (to.empty() && from.empty()) return;
  to.resize(corners);
  to.insert(to.end(), from.begin(), from.end());
  to.resize(corners + more);
  from = {};
}

void append_names(std::vector<std::string>& to, std::vector<std::string>& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

}  // namespace

void name_parts(MeshWithAppearance& source, const std::string& name, MemoryBudget* memory) {
  Mesh& mesh = source.mesh;
  const std::uint64_t before = all_bytes(source);
  if (mesh.triangle_materials.empty()) {
    mesh.triangle_materials.assign(mesh.triangles.size(), 0);
    mesh.materials = {name};
    for (Material& material : source.appearance.materials) material.name = name;
  }
  for (std::string& object : mesh.objects) object.insert(0, name + "/");
  if (mesh.objects.empty()) {
    mesh.objects = {name};
    mesh.object_runs = {{0, 0}};
  }
  const std::uint64_t after = all_bytes(source);
  if (memory != nullptr && after > before) memory->reserve(after - before);
}

void append_mesh(MeshWithAppearance& to, MeshWithAppearance from, MemoryBudget* memory) {
  Mesh &mesh = to.mesh, &more = from.mesh;
  const std::size_t vertices = mesh.vertices.size(), triangles = mesh.triangles.size();
  if (vertices + more.vertices.size() >= 0xFFFFFFFF ||
      triangles + more.triangles.size() > 0x55555555)
    throw Error(
        "the files have more than 4,294,967,294 vertices or 1,431,655,765 triangles together");
  const std::uint64_t before = all_bytes(to) + all_bytes(from);
  // Arrays that grow are copied into ones of up to twice the size.
  MemoryReservation growth(memory, before + all_bytes(to));
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (Triangle& triangle : more.triangles)
    for (std::uint32_t& vertex : triangle) vertex += static_cast<std::uint32_t>(vertices);
  mesh.triangles.insert(mesh.triangles.end(), more.triangles.begin(), more.triangles.end());
  if (mesh.origin != more.origin)
    place_vertices(mesh, [&](std::size_t i) {
      return from_origin(i < vertices ? mesh.origin : more.origin, mesh.vertices[i]);
    });
  for (std::uint32_t& material : more.triangle_materials)
    material += static_cast<std::uint32_t>(mesh.materials.size());
  mesh.triangle_materials.insert(mesh.triangle_materials.end(), more.triangle_materials.begin(),
                                 more.triangle_materials.end());
  for (const ObjectRun& run : more.object_runs)
    mesh.object_runs.push_back({triangles + run.first_triangle,
                                run.object + static_cast<std::uint32_t>(mesh.objects.size())});

  Appearance &look = to.appearance, &more_look = from.appearance;
  // Without an appearance there are no materials but names.
  if (!look.materials.empty()) {
    const std::size_t corners = 3 * triangles, more_corners = 3 * more.triangles.size();
    append_corners(look.normals, more_look.normals, corners, more_corners);
    append_corners(look.uvs, more_look.uvs, corners, more_corners);
    append_corners(look.colors, more_look.colors, corners, more_corners);
    const auto images = static_cast<int>(look.images.size());
    look.materials.resize(mesh.materials.size());
    more_look.materials.resize(more.materials.size());
    for (Material& material : more_look.materials) {
      for (TextureUse* use :
           {&material.color_map, &material.emission_map, &material.alpha_map, &material.normal_map,
            &material.displacement_map, &material.metallic_map, &material.roughness_map})
        if (use->exists()) use->image += images;
      look.materials.push_back(std::move(material));
    }
    look.images.insert(look.images.end(), std::make_move_iterator(more_look.images.begin()),
                       std::make_move_iterator(more_look.images.end()));
  }
  append_names(mesh.materials, more.materials);
  append_names(mesh.objects, more.objects);
  append_names(to.warnings, from.warnings);
  if (memory == nullptr) return;
  from = {};
  growth.resize(0);
  memory->release(before);
  memory->reserve(all_bytes(to));
}

CountedVector<std::uint32_t> ids_of_runs(std::span<const ObjectRun> runs, std::uint64_t triangles,
                                         MemoryBudget* memory) {
  CountedVector<std::uint32_t> ids(memory);
  ids.reserve(triangles);
  for (std::size_t i = 0; i < runs.size(); ++i)
    ids.resize(i + 1 < runs.size() ? runs[i + 1].first_triangle : triangles, runs[i].object);
  return ids;
}

}  // namespace voxdag
