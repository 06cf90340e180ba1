/// Fuzzes the library's own mesh readers. The first byte chooses the reader and whether the
/// appearance is read. The result must be a valid mesh with an appearance of matching size, or an
/// Error.
#include <cmath>
#include <cstdlib>

#include "mesh_readers.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace voxdag;
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    const auto [mesh, a, warnings] = read_chosen_mesh(data[0], {bytes, "fuzz", {}, nullptr, {}});
    if (mesh.triangles.empty()) std::abort();
    for (const Triangle& triangle : mesh.triangles)
      for (const std::uint32_t index : triangle) {
        const Vec3f p = mesh.vertices.at(index);
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) std::abort();
      }
    for (const std::uint32_t material : mesh.triangle_materials)
      if (material >= mesh.materials.size()) std::abort();
    for (const std::size_t count : {a.normals.size(), a.uvs.size(), a.colors.size()})
      if (count != 0 && count != 3 * mesh.triangles.size()) std::abort();
  } catch (const Error&) {
  }
  return 0;
}
