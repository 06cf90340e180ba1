#include "voxdag/mesh/surface/surface_shading.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "voxdag/core/angles.hpp"
#include "voxdag/image/color.hpp"
#include "voxdag/mesh/surface/surface_tables.hpp"

namespace voxdag {
namespace {

/// Returns whether all colours within the bounds differ from `mean` by at most `error` (sRGB
/// encoded).
bool is_near(const ColorBounds& bounds, Vec3f mean, float error) {
  if (bounds.lo == mean && bounds.hi == mean) return true;
  for (int c = 0; c < 3; ++c) {
    const float encoded = linear_to_srgb_fast(mean[c]);
    if (linear_to_srgb_fast(bounds.hi[c]) - encoded > error ||
        encoded - linear_to_srgb_fast(bounds.lo[c]) > error)
      return false;
  }
  return true;
}

/// Returns the nearest visible colour, premultiplied, and its alpha: the value at a point of the
/// finest level in which it is not 0.
Texture::Value nearest_visible(const Texture& texture, Vec2f uv) {
  Texture::Value value = texture.sample(0, uv);
  for (int level = 1; !(value[3] > 0) && level < texture.level_count(); ++level)
    value = texture.sample(level, uv);
  return value;
}

}  // namespace

SurfaceShading::SurfaceShading(const Mesh& mesh, const Appearance& appearance,
                               std::vector<std::string>* warnings, Work work,
                               bool with_metallic_roughness) {
  std::vector<std::string> ignored_warnings;
  std::vector<ResolvedMaterial> materials = load_materials(
      appearance, !appearance.uvs.empty(), warnings == nullptr ? ignored_warnings : *warnings, work,
      with_metallic_roughness);
  if (materials.empty()) materials.emplace_back();
  const bool has_normal_maps = std::any_of(
      materials.begin(), materials.end(),
      [](const ResolvedMaterial& material) { return material.normal_texture != nullptr; });
  TangentTable tangents;
  if (has_normal_maps)
    tangents = TangentTable(
        mesh, appearance,
        [&](std::size_t t) -> const UvTransform* {
          const ResolvedMaterial& material = materials[Appearance::material_index(mesh, t)];
          return material.normal_texture ? &material.normal_uv : nullptr;
        },
        work);
  tables_ = std::make_unique<const SurfaceTables>(
      SurfaceTables{mesh, appearance, std::move(materials), std::move(tangents)});
}

SurfaceShading::~SurfaceShading() = default;
SurfaceShading::SurfaceShading(SurfaceShading&&) noexcept = default;

SurfaceSample SurfaceShading::mean(std::uint32_t t, std::span<const Vec2f> polygon,
                                   bool with_normal) const {
  const SurfaceTables& tables = *tables_;
  const ResolvedMaterial& material = tables.material(t);
  const bool has_normal_texture = with_normal && material.normal_texture;
  const bool is_plain = has_one_color(t) && !has_normal_texture;
  const Vec3f plain = min(material.color + material.emission, Vec3f{1, 1, 1});
  const MetallicRoughness numbers = material.metallic_roughness;
  if (is_plain && !with_normal) return {plain, 1, {}, numbers};
  if (is_plain && has_one_normal(t)) {
    const Vec3f* const n = tables.normals(t);
    return {plain, 1, n == nullptr ? face_normal(tables.mesh, t) : n[0], numbers};
  }
  const PolygonMoments moments = polygon_moments(polygon);
  SurfaceSample sample{plain, 1, with_normal ? tables.mean_normal(t, polygon, moments) : Vec3f{},
                       numbers};
  if (is_plain) return sample;
  sample.color = material.color;
  if (!tables.appearance.colors.empty())
    sample.color = sample.color * tables.corner_colors(t)(moments.center);
  if (material.color_texture) {
    const UvRegion region = region_of(moments, tables.uv(t), material.color_uv);
    Texture::Value value = material.color_texture->mean(region);
    float scale = kTexelScale;
    if (material.is_alpha_textured) {
      // Makes coverages of 0 and 1 exact, despite the rounding of the filter.
      sample.coverage = value[3] > 65534.5f ? 1 : value[3] < 0.5f ? 0 : value[3] * kTexelScale;
      if (!(sample.coverage > 0)) value = nearest_visible(*material.color_texture, region.center);
      scale = value[3] > 0 ? 1 / value[3] : 0;
    }
    sample.color = sample.color * Vec3f{value[0] * scale, value[1] * scale, value[2] * scale};
  }
  if (material.emission != Vec3f{}) {
    Vec3f emission = material.emission;
    if (material.emission_texture) {
      const Texture::Value value =
          material.emission_texture->mean(region_of(moments, tables.uv(t), material.emission_uv));
      emission = emission * (Vec3f{value[0], value[1], value[2]} * kTexelScale);
    }
    sample.color = min(sample.color + emission, Vec3f{1, 1, 1});
  }
  if (material.metallic_texture)
    sample.metallic_roughness.metallic *=
        material.metallic_texture->mean(region_of(moments, tables.uv(t), material.metallic_uv))[2] *
        kTexelScale;
  if (material.roughness_texture)
    sample.metallic_roughness.roughness *= material.roughness_texture->mean(region_of(
                                               moments, tables.uv(t), material.roughness_uv))[1] *
                                           kTexelScale;
  if (!tables.is_visible(t, material, moments.center)) sample.coverage = 0;
  if (has_normal_texture) {
    const CornerTangents corners = tables.tangents[t];
    if (corners.tangents == nullptr) return sample;
    const Texture::Value value =
        material.normal_texture->mean(region_of(moments, tables.uv(t), material.normal_uv));
    const float agreement = std::sqrt(dot(sample.normal, sample.normal));
    sample.normal = tables.frame_at(t, corners, moments.center)
                        .to_world(Vec3f{unpack_component(value[0]), unpack_component(value[1]),
                                        unpack_component(value[2])} *
                                  agreement);
  }
  return sample;
}

bool SurfaceShading::has_normal_map(std::uint32_t t) const {
  return tables_->material(t).normal_texture != nullptr;
}

bool SurfaceShading::has_one_color(std::uint32_t t) const {
  const ResolvedMaterial& material = tables_->material(t);
  return !material.color_texture && !material.emission_texture && !material.metallic_texture &&
         !material.roughness_texture && tables_->appearance.colors.empty() &&
         material.least_corner_alpha <= 0;
}

bool SurfaceShading::has_one_normal(std::uint32_t t) const {
  const Vec3f* const n = tables_->normals(t);
  return !tables_->material(t).normal_texture && (n == nullptr || (n[0] == n[1] && n[0] == n[2]));
}

bool SurfaceShading::is_uniform(std::uint32_t t, std::span<const Vec2f> polygon, float color_error,
                                float normal_error, const SurfaceSample& mean) const {
  const SurfaceTables& tables = *tables_;
  const ResolvedMaterial& material = tables.material(t);
  if (may_be_alpha_masked(t)) {
    if (mean.coverage == 0) return is_alpha_masked(t, polygon);
    if (tables.corner_alphas(t).first < material.least_corner_alpha) return false;
    if (material.is_alpha_textured &&
        bounds_of(*material.color_texture, polygon, tables.uv(t), material.color_uv).lo[3] < 65535)
      return false;
  }
  return is_near(tables.color_bounds(t, material, polygon), mean.color, color_error) &&
         tables.is_direction_near(t, material, polygon, mean.normal, normal_error);
}

bool SurfaceShading::may_be_uniform(std::uint32_t t, std::span<const Vec2f> polygon,
                                    float color_error, float normal_error) const {
  const SurfaceTables& tables = *tables_;
  const ResolvedMaterial& material = tables.material(t);
  if (material.color_texture || material.emission_texture || !tables.appearance.colors.empty()) {
    const ColorBounds bounds = tables.color_bounds(t, material, polygon);
    for (int c = 0; c < 3; ++c)
      if (linear_to_srgb_fast(bounds.hi[c]) - linear_to_srgb_fast(bounds.lo[c]) > 2 * color_error)
        return false;
  }
  if (!material.normal_texture || tables.tangents[t].tangents == nullptr || normal_error > 1.5f)
    return true;
  const Texture::Bounds texels =
      bounds_of(*material.normal_texture, polygon, tables.uv(t), material.normal_uv);
  Vec3f lo, hi;
  for (unsigned axis = 0; axis < 3; ++axis) {
    lo[static_cast<int>(axis)] = unpack_component(static_cast<float>(texels.lo[axis]));
    hi[static_cast<int>(axis)] = unpack_component(static_cast<float>(texels.hi[axis]));
  }
  return dot(normalized_or(lo, {}), normalized_or(hi, {})) >=
         static_cast<float>(cosine_of(2 * normal_error)) - 1e-5f;
}

bool SurfaceShading::is_alpha_masked(std::uint32_t t, std::span<const Vec2f> polygon) const {
  const SurfaceTables& tables = *tables_;
  const ResolvedMaterial& material = tables.material(t);
  if (tables.corner_alphas(t).second < material.least_corner_alpha) return true;
  return material.is_alpha_textured &&
         bounds_of(*material.color_texture, polygon, tables.uv(t), material.color_uv).hi[3] == 0;
}

bool SurfaceShading::is_visible(std::uint32_t t, std::span<const Vec2f> polygon) const {
  const ResolvedMaterial& material = tables_->material(t);
  if (mean(t, polygon, false).coverage == 0) return false;
  if (!material.is_alpha_textured) return true;
  const UvBox box = box_of(polygon, tables_->uv(t), material.color_uv);
  return material.color_texture->bounds(box.lo, box.hi, Texture::kUnfiltered).hi[3] > 0;
}

bool SurfaceShading::may_be_alpha_masked(std::uint32_t t) const {
  const ResolvedMaterial& material = tables_->material(t);
  return material.is_alpha_textured ||
         (material.least_corner_alpha > 0 &&
          (material.least_corner_alpha > 1 || !tables_->appearance.colors.empty()));
}

const Appearance& SurfaceShading::appearance() const { return tables_->appearance; }

std::uint64_t SurfaceShading::bytes() const {
  std::vector<const Texture*> textures;
  for (const ResolvedMaterial& material : tables_->materials) {
    textures.push_back(material.color_texture.get());
    textures.push_back(material.emission_texture.get());
    textures.push_back(material.normal_texture.get());
    textures.push_back(material.metallic_texture.get());
    textures.push_back(material.roughness_texture.get());
  }
  std::sort(textures.begin(), textures.end());
  textures.erase(std::unique(textures.begin(), textures.end()), textures.end());
  std::uint64_t sum = tables_->tangents.bytes();
  for (const Texture* texture : textures) sum += texture == nullptr ? 0 : texture->bytes();
  return sum;
}

}  // namespace voxdag
