#include "voxdag/mesh_view/mesh_appearance.hpp"

#include <algorithm>

#include "voxdag/mesh_view/corner_normals.hpp"

namespace voxdag {
namespace {

bool has_colors(const Appearance& appearance) {
  return !appearance.colors.empty() ||
         std::any_of(appearance.materials.begin(), appearance.materials.end(),
                     [](const Material& material) {
                       return material.color_map.exists() || material.base_color != Vec3f{1, 1, 1};
                     });
}

bool has_normals(const Appearance& appearance, std::size_t triangle) {
  if (appearance.normals.empty()) return false;
  const Vec3f* const n = &appearance.normals[3 * triangle];
  return n[0] != Vec3f{} && n[1] != Vec3f{} && n[2] != Vec3f{};
}

}  // namespace

MeshAppearance::MeshAppearance(const Mesh& mesh, const MeshViewOptions& options)
    : albedo_(options.albedo), smooth_normals_(corner_normals(mesh, options.crease_degrees)) {}

MeshAppearance::MeshAppearance(const Mesh& mesh, Appearance appearance,
                               const MeshViewOptions& options, std::vector<std::string>* warnings,
                               Work work)
    : albedo_(options.albedo),
      appearance_(std::move(appearance)),
      has_colors_(voxdag::has_colors(*appearance_)) {
  shading_.emplace(mesh, *appearance_, warnings, work);
  bool all_have_normals = true;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    has_holes_ |= shading_->may_be_alpha_masked(static_cast<std::uint32_t>(t));
    all_have_normals &= has_normals(*appearance_, t);
  }
  if (!all_have_normals) smooth_normals_ = corner_normals(mesh, options.crease_degrees);
}

Vec3f MeshAppearance::albedo(std::uint32_t triangle, std::span<const Vec2f> footprint) const {
  if (!has_colors_) return albedo_;
  const Vec3f color = shading_->mean(triangle, footprint).color;
  return min(max(color, Vec3f{}), Vec3f{1, 1, 1});
}

Vec3f MeshAppearance::normal(std::uint32_t triangle, Vec2f point,
                             std::span<const Vec2f> footprint) const {
  const bool is_mapped = shading_ && shading_->has_normal_map(triangle);
  if (is_mapped) return shading_->mean(triangle, footprint).normal;
  const auto interpolated = [&](const auto& corner) {
    return corner(0) * (1 - point.x - point.y) + corner(1) * point.x + corner(2) * point.y;
  };
  if (appearance_ && has_normals(*appearance_, triangle))
    return interpolated(
        [&](std::size_t i) { return appearance_->normals[3 * std::size_t{triangle} + i]; });
  return interpolated([&](std::size_t i) { return smooth_normals_[triangle][i].unpack(); });
}

bool MeshAppearance::is_hole(std::uint32_t triangle, Vec2f point) const {
  return has_holes_ && shading_->may_be_alpha_masked(triangle) &&
         shading_->mean(triangle, std::span(&point, 1)).coverage < 0.5f;
}

}  // namespace voxdag
