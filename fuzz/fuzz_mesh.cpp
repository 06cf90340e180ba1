/// Fuzzes the library's own mesh readers. The first byte chooses the reader; the others are the
/// file. The result must be a sound mesh, whose appearance fits it, or an Error.
#include <cmath>
#include <cstdlib>

#include "voxdag/readers/gltf/gltf_reader.hpp"
#include "voxdag/readers/obj/obj_appearance.hpp"
#include "voxdag/readers/obj/obj_reader.hpp"
#include "voxdag/readers/off/off_reader.hpp"
#include "voxdag/readers/ply/ply_appearance.hpp"
#include "voxdag/readers/ply/ply_reader.hpp"
#include "voxdag/readers/stl/stl_reader.hpp"

namespace {

/// Checks that attributes have the mesh's size, even if parts of them are malformed.
void check_appearance(int reader, const voxdag::MeshBytes& source, const voxdag::Mesh& mesh) {
  using namespace voxdag;
  std::vector<std::string> warnings;
  Appearance a;
  if (reader == 0)
    a = read_obj_appearance(source, mesh, warnings);
  else if (reader == 1)
    a = read_ply_appearance(source, mesh, warnings);
  else if (reader == 3)
    a = read_gltf_with_appearance(source).appearance;
  else
    return;
  for (const std::size_t size : {a.normals.size(), a.uvs.size(), a.colors.size()})
    if (size != 0 && size != 3 * mesh.triangles.size()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace voxdag;
  if (size == 0) return 0;
  using Reader = Mesh (*)(const MeshBytes&);
  constexpr Reader readers[] = {read_obj, read_ply, read_stl, read_gltf, read_off};
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    const Mesh mesh = readers[data[0] % 5]({bytes, "fuzz", {}, nullptr, nullptr});
    if (mesh.triangles.empty()) std::abort();
    for (const Triangle& triangle : mesh.triangles)
      for (const std::uint32_t index : triangle) {
        const Vec3f p = mesh.vertices.at(index);
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) std::abort();
      }
    for (const std::uint32_t material : mesh.triangle_materials)
      if (material >= mesh.materials.size()) std::abort();
    check_appearance(data[0] % 5, {bytes, "fuzz", {}, nullptr, nullptr}, mesh);
  } catch (const Error&) {
  }
  return 0;
}
