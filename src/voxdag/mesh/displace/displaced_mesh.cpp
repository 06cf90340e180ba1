#include "voxdag/mesh/displace/displaced_mesh.hpp"

#include "voxdag/mesh/surface/tangent_frames.hpp"

namespace voxdag {

std::array<Vec3f, 3> DisplacedMesh::normals(std::uint32_t triangle) const {
  if (!appearance.normals.empty()) {
    const Vec3f* const n = appearance.normals.data() + 3 * std::size_t{triangle};
    if (n[0] != Vec3f{} && n[1] != Vec3f{} && n[2] != Vec3f{}) return {n[0], n[1], n[2]};
  }
  const Vec3f n = face_normal(mesh, triangle);
  return {n, n, n};
}

}  // namespace voxdag
