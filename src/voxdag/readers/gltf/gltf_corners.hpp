#pragma once
/// The attributes of the corners of glTF triangles, gathered while the mesh is read.
#include <array>
#include <string>
#include <vector>

#include "voxdag/core/vec2.hpp"
#include "voxdag/mesh/appearance.hpp"
#include "voxdag/readers/gltf/gltf_file.hpp"

namespace voxdag {

/// An affine map: columns x, y, z and the translation.
struct GltfTransform {
  std::array<Vec3d, 4> columns{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}};

  Vec3d direction(Vec3d v) const { return columns[0] * v.x + columns[1] * v.y + columns[2] * v.z; }
  Vec3d point(Vec3d p) const { return direction(p) + columns[3]; }
  /// What normals become: the inverse transposed, up to a positive factor. Zero where the map
  /// flattens space to less than a plane.
  Vec3d normal(Vec3d n) const {
    const Vec3d x = cross(columns[1], columns[2]), y = cross(columns[2], columns[0]),
                z = cross(columns[0], columns[1]);
    const Vec3d mapped = x * n.x + y * n.y + z * n.z;
    return dot(columns[0], x) < 0 ? -mapped : mapped;
  }
  friend GltfTransform operator*(const GltfTransform& a, const GltfTransform& b) {
    return {{a.direction(b.columns[0]), a.direction(b.columns[1]), a.direction(b.columns[2]),
             a.point(b.columns[3])}};
  }
};

class GltfCorners {
 public:
  GltfCorners(Appearance& appearance, std::vector<std::string>& warnings)
      : appearance_(appearance), warnings_(warnings) {}

  /// Loads the attributes of a primitive with so many vertices. What is malformed is left out with
  /// a warning.
  void start(const GltfFile& file, const GltfValue& primitive, const GltfTransform& transform,
             std::size_t vertices);
  /// Adds the next triangle of the mesh, whose vertices count from `first_vertex`.
  void add(const Triangle& triangle, std::uint32_t first_vertex);

 private:
  Appearance& appearance_;
  std::vector<std::string>& warnings_;
  std::size_t triangles_ = 0;  ///< Added so far.
  std::vector<Vec3f> normals_;
  std::vector<Vec2f> uvs_;
  std::vector<std::array<float, 4>> colors_;
};

}  // namespace voxdag
