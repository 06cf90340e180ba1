#include "voxdag/readers/gltf/gltf_corners.hpp"

#include <cmath>

#include "voxdag/readers/gltf/gltf_accessor.hpp"
#include "voxdag/readers/gltf/gltf_materials.hpp"

namespace voxdag {
namespace {

/// An attribute of a primitive; nothing if it has none or a malformed one.
template <class T, class Read>
std::vector<T> load(const GltfFile& file, const GltfValue& primitive, const std::string& name,
                    std::size_t vertices, std::vector<std::string>& warnings, const Read& read) {
  try {
    const GltfValue index = primitive["attributes"][name.c_str()];
    if (!index.exists()) return {};
    const GltfValue& accessor = file.item("accessors", index.whole(), primitive);
    if (gltf_count(accessor) != vertices)
      throw accessor.error(name + " of " + std::to_string(gltf_count(accessor)) + " elements for " +
                           std::to_string(vertices) + " vertices");
    return read(file, accessor);
  } catch (const Error& error) {
    warnings.push_back(std::string(error.what()) + ": " + name + " is left out");
    return {};
  }
}

Vec3f transformed(const GltfTransform& transform, Vec3f normal) {
  return static_cast<Vec3f>(normalized_or(transform.normal(static_cast<Vec3d>(normal)), {}));
}

/// Fits an array of the appearance to the triangles so far, if it is used from now on.
template <class T>
void begin(std::vector<T>& array, bool used, std::size_t triangles) {
  if (used && array.empty()) array.resize(3 * triangles);
}

}  // namespace

void GltfCorners::start(const GltfFile& file, const GltfValue& primitive,
                        const GltfTransform& transform, std::size_t vertices) {
  normals_ = load<Vec3f>(file, primitive, "NORMAL", vertices, warnings_, read_gltf_normals);
  for (Vec3f& normal : normals_) normal = transformed(transform, normal);
  const std::string set = "TEXCOORD_" + std::to_string(gltf_uv_set(file, primitive));
  uvs_ = load<Vec2f>(file, primitive, set, vertices, warnings_, read_gltf_uvs);
  for (Vec2f& uv : uvs_)
    if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) uv = {};
  colors_ =
      load<std::array<float, 4>>(file, primitive, "COLOR_0", vertices, warnings_, read_gltf_colors);
  // Growing them only here leaves arrays empty that no primitive needs.
  begin(appearance_.normals, !normals_.empty(), triangles_);
  begin(appearance_.uvs, !uvs_.empty(), triangles_);
  begin(appearance_.colors, !colors_.empty(), triangles_);
}

void GltfCorners::add(const Triangle& triangle, std::uint32_t first_vertex) {
  // An array that is empty at the first triangle and needed later is filled up by begin().
  const bool has_normals = !normals_.empty() || !appearance_.normals.empty();
  const bool has_uvs = !uvs_.empty() || !appearance_.uvs.empty();
  const bool has_colors = !colors_.empty() || !appearance_.colors.empty();
  for (const std::uint32_t vertex : triangle) {
    const std::size_t i = vertex - first_vertex;
    if (has_normals) appearance_.normals.push_back(normals_.empty() ? Vec3f{} : normals_[i]);
    if (has_uvs) appearance_.uvs.push_back(uvs_.empty() ? Vec2f{} : uvs_[i]);
    if (!has_colors) continue;
    const std::array<float, 4> c = colors_.empty() ? std::array<float, 4>{1, 1, 1, 1} : colors_[i];
    appearance_.colors.push_back(to_rgba16({c[0], c[1], c[2]}, c[3]));
  }
  ++triangles_;
}

}  // namespace voxdag
