#include "voxdag/formats/scenes/ply_writer.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <span>
#include <string>

#include "voxdag/core/io/atomic_file.hpp"

namespace voxdag {
namespace {

static_assert(std::endian::native == std::endian::little,
              "vertices and faces are written as they lie");
static_assert(sizeof(Vec3f) == 12 && sizeof(Triangle) == 12);

std::string header(const Mesh& mesh, bool with_materials) {
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  if (with_materials) {
    for (std::size_t i = 0; i < mesh.materials.size(); ++i) {
      std::string name = mesh.materials[i];
      std::replace_if(
          name.begin(), name.end(), [](unsigned char c) { return c < 32; }, ' ');
      text += "comment material " + std::to_string(i) + " " + name + "\n";
    }
  }
  text += "element vertex " + std::to_string(mesh.vertices.size()) +
          "\nproperty float x\nproperty float y\nproperty float z\n";
  text += "element face " + std::to_string(mesh.triangles.size()) +
          "\nproperty list uchar uint vertex_indices\n";
  if (with_materials) text += "property uint material_index\n";
  return text + "end_header\n";
}

}  // namespace

void write_ply(const std::filesystem::path& path, const Mesh& mesh, Work work) {
  const bool with_materials = !mesh.triangle_materials.empty();
  AtomicFile file(path);
  file.write(header(mesh, with_materials));
  file.write(std::span<const Vec3f>(mesh.vertices));
  std::array<unsigned char, 17> face{3};  // count, three indices, material
  const std::size_t bytes = with_materials ? 17 : 13;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    work.poll();
    std::memcpy(face.data() + 1, &mesh.triangles[i], 12);
    if (with_materials) std::memcpy(face.data() + 13, &mesh.triangle_materials[i], 4);
    file.write(face.data(), bytes);
  }
  file.commit();
}

}  // namespace voxdag
