#include "voxdag/surface/surface_shading.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "voxdag/image/color.hpp"
#include "voxdag/surface/material_textures.hpp"
#include "voxdag/surface/polygon_moments.hpp"
#include "voxdag/surface/tangent_frames.hpp"

namespace voxdag {
namespace {

/// A value that is linear over a triangle: v + b1 * d1 + b2 * d2.
template <class T>
struct Linear {
  T v, d1, d2;

  Linear(const T& v0, const T& v1, const T& v2) : v(v0), d1(v1 - v0), d2(v2 - v0) {}
  T operator()(Vec2f b) const { return v + d1 * b.x + d2 * b.y; }
};

UvRegion region_of(const PolygonMoments& m, const Linear<Vec2f>& uv, const UvTransform& transform) {
  const Vec2f a = transform.linear(uv.d1), b = transform.linear(uv.d2);
  return {transform(uv(m.center)), a.x * a.x * m.xx + 2 * a.x * b.x * m.xy + b.x * b.x * m.yy,
          a.x * a.y * m.xx + (a.x * b.y + b.x * a.y) * m.xy + b.x * b.y * m.yy,
          a.y * a.y * m.xx + 2 * a.y * b.y * m.xy + b.y * b.y * m.yy};
}

struct UvBox {
  Vec2f lo, hi;
};

UvBox box_of(std::span<const Vec2f> polygon, const Linear<Vec2f>& uv,
             const UvTransform& transform) {
  UvBox box{transform(uv(polygon[0])), {}};
  box.hi = box.lo;
  for (const Vec2f b : polygon.subspan(1)) {
    const Vec2f p = transform(uv(b));
    box.lo = {std::min(box.lo.x, p.x), std::min(box.lo.y, p.y)};
    box.hi = {std::max(box.hi.x, p.x), std::max(box.hi.y, p.y)};
  }
  return box;
}

Texture::Bounds bounds_of(const Texture& texture, std::span<const Vec2f> polygon,
                          const Linear<Vec2f>& uv, const UvTransform& transform) {
  const UvBox box = box_of(polygon, uv, transform);
  return texture.bounds(box.lo, box.hi);
}

/// Axes of tangent space: unit and orthogonal.
struct Frame {
  Vec3f tangent, bitangent, normal;

  Vec3f to_world(Vec3f v) const { return tangent * v.x + bitangent * v.y + normal * v.z; }
  Vec3f to_local(Vec3f v) const { return {dot(tangent, v), dot(bitangent, v), dot(normal, v)}; }
};

Frame make_frame(Vec3f normal, Vec3f tangent, float handedness) {
  tangent = tangent - normal * dot(normal, tangent);
  if (dot(tangent, tangent) < 1e-12f) {
    const Vec3f other = std::abs(normal.x) < 0.7f ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0};
    tangent = cross(other, normal);
  }
  tangent = normalized_or(tangent, {});
  return {tangent, cross(normal, tangent) * handedness, normal};
}

/// Returns the angle of the rotation from one frame to the other, in radians.
float angle_between(const Frame& a, const Frame& b) {
  const float trace =
      dot(a.tangent, b.tangent) + dot(a.bitangent, b.bitangent) + dot(a.normal, b.normal);
  return std::acos(std::clamp((trace - 1) / 2, -1.0f, 1.0f));
}

struct ColorBounds {
  Vec3f lo, hi;
};

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

constexpr float kTexelScale = 1.0f / 65535;

}  // namespace

struct SurfaceShading::Tables {
  const Mesh& mesh;
  const Appearance& appearance;
  std::vector<MaterialLook> looks;
  TangentTable tangents;

  const MaterialLook& look(std::uint32_t t) const {
    return looks[Appearance::material_index(mesh, t)];
  }
  Linear<Vec2f> uv(std::uint32_t t) const {
    const Vec2f* const p = appearance.uvs.data() + 3 * std::size_t{t};
    return {p[0], p[1], p[2]};
  }
  /// Returns the normals of the corners; null if the triangle has the normal of its plane.
  const Vec3f* normals(std::uint32_t t) const {
    if (appearance.normals.empty()) return nullptr;
    const Vec3f* const n = appearance.normals.data() + 3 * std::size_t{t};
    return n[0] == Vec3f{} || n[1] == Vec3f{} || n[2] == Vec3f{} ? nullptr : n;
  }
  Linear<Vec3f> corner_colors(std::uint32_t t) const {
    const Rgba16* const c = appearance.colors.data() + 3 * std::size_t{t};
    return {c[0].color(), c[1].color(), c[2].color()};
  }
  /// Returns the least and the greatest alpha of the corners.
  std::pair<float, float> corner_alphas(std::uint32_t t) const {
    if (appearance.colors.empty()) return {1.0f, 1.0f};
    const Rgba16* const c = appearance.colors.data() + 3 * std::size_t{t};
    const auto [lo, hi] = std::minmax({c[0].alpha(), c[1].alpha(), c[2].alpha()});
    return {lo, hi};
  }
  bool is_visible(std::uint32_t t, const MaterialLook& look, Vec2f b) const {
    if (look.least_corner_alpha <= 0) return true;
    if (appearance.colors.empty()) return look.least_corner_alpha <= 1;
    const Rgba16* const c = appearance.colors.data() + 3 * std::size_t{t};
    return Linear<float>(c[0].alpha(), c[1].alpha(), c[2].alpha())(b) >= look.least_corner_alpha;
  }

  Vec3f mean_normal(std::uint32_t t, std::span<const Vec2f> polygon,
                    const PolygonMoments& moments) const;
  Frame frame_at(std::uint32_t t, const TangentFrames& tangents, Vec2f b) const;
  ColorBounds color_bounds(std::uint32_t t, const MaterialLook& look,
                           std::span<const Vec2f> polygon) const;
  bool is_direction_near(std::uint32_t t, const MaterialLook& look, std::span<const Vec2f> polygon,
                         Vec3f direction, float error) const;
};

Vec3f SurfaceShading::Tables::mean_normal(std::uint32_t t, std::span<const Vec2f> polygon,
                                          const PolygonMoments& moments) const {
  const Vec3f* const n = normals(t);
  if (n == nullptr) return face_normal(mesh, t);
  if (n[0] == n[1] && n[0] == n[2]) return n[0];
  // Exact for polynomials of degree two over a triangle.
  const Linear<Vec3f> normal(n[0], n[1], n[2]);
  Vec3f corners{};
  for (const Vec2f b : polygon) corners = corners + normalized_or(normal(b), {});
  return normalized_or(normal(moments.center), {}) * 0.75f +
         corners * (0.25f / static_cast<float>(polygon.size()));
}

Frame SurfaceShading::Tables::frame_at(std::uint32_t t, const TangentFrames& frames,
                                       Vec2f b) const {
  const Vec3f* const n = normals(t);
  const Vec3f normal =
      n == nullptr ? face_normal(mesh, t) : normalized_or(Linear<Vec3f>(n[0], n[1], n[2])(b), {});
  const Vec3f* const p = frames.tangents;
  return make_frame(normal, Linear<Vec3f>(p[0], p[1], p[2])(b), frames.handedness);
}

ColorBounds SurfaceShading::Tables::color_bounds(std::uint32_t t, const MaterialLook& look,
                                                 std::span<const Vec2f> polygon) const {
  ColorBounds bounds{look.color, look.color};
  if (!appearance.colors.empty()) {
    const Linear<Vec3f> color = corner_colors(t);
    Vec3f lo = color(polygon[0]), hi = lo;
    for (const Vec2f b : polygon.subspan(1)) {
      lo = min(lo, color(b));
      hi = max(hi, color(b));
    }
    bounds = {bounds.lo * max(lo, Vec3f{}), bounds.hi * hi};
  }
  if (look.color_texture) {
    const Texture::Bounds texels = bounds_of(*look.color_texture, polygon, uv(t), look.color_uv);
    for (int c = 0; c < 3; ++c) {
      bounds.lo[c] *= static_cast<float>(texels.lo[static_cast<std::size_t>(c)]) * kTexelScale;
      bounds.hi[c] *= static_cast<float>(texels.hi[static_cast<std::size_t>(c)]) * kTexelScale;
    }
  }
  return bounds;
}

bool SurfaceShading::Tables::is_direction_near(std::uint32_t t, const MaterialLook& look,
                                               std::span<const Vec2f> polygon, Vec3f direction,
                                               float error) const {
  if (error >= std::numbers::pi_v<float>) return true;
  direction = normalized_or(direction, {});
  const TangentFrames frames = look.normal_texture ? tangents[t] : TangentFrames{};
  if (frames.tangents == nullptr) {
    const float least = std::cos(error);
    const Vec3f* const n = normals(t);
    if (n == nullptr || (n[0] == n[1] && n[0] == n[2])) {
      const Vec3f normal = n == nullptr ? face_normal(mesh, t) : n[0];
      return normal == Vec3f{} || dot(normal, direction) >= least - 1e-6f;
    }
    // If the corners lie in a cone of less than half of space, so do all normals between them.
    if (least <= 0) return false;
    const Linear<Vec3f> normal(n[0], n[1], n[2]);
    return std::all_of(polygon.begin(), polygon.end(), [&](Vec2f b) {
      return dot(normalized_or(normal(b), {}), direction) >= least - 1e-6f;
    });
  }
  const Frame center = frame_at(t, frames, polygon_moments(polygon).center);
  float turn = 0;
  for (const Vec2f b : polygon)
    turn = std::max(turn, angle_between(center, frame_at(t, frames, b)));
  // Between the corners a frame can turn a little more than at the corners.
  const float left = error - 1.25f * turn;
  if (!(left > 0)) return false;
  const float least = std::cos(std::min(left, 1.5f));
  const Texture::Bounds texels = bounds_of(*look.normal_texture, polygon, uv(t), look.normal_uv);
  const Vec3f local = center.to_local(direction);
  for (unsigned corner = 0; corner < 8; ++corner) {
    Vec3f n;
    for (unsigned axis = 0; axis < 3; ++axis)
      n[static_cast<int>(axis)] = unpack_component(
          static_cast<float>((corner >> axis & 1) != 0 ? texels.hi[axis] : texels.lo[axis]));
    if (!(dot(normalized_or(n, {}), local) >= least - 1e-6f)) return false;
  }
  return true;
}

SurfaceShading::SurfaceShading(const Mesh& mesh, const Appearance& appearance,
                               std::vector<std::string>* warnings, Progress* progress,
                               MemoryBudget* memory) {
  std::vector<std::string> unheard;
  std::vector<MaterialLook> looks =
      load_material_looks(appearance, !appearance.uvs.empty(),
                          warnings == nullptr ? unheard : *warnings, progress, memory);
  if (looks.empty()) looks.emplace_back();
  const bool has_normal_maps =
      std::any_of(looks.begin(), looks.end(),
                  [](const MaterialLook& look) { return look.normal_texture != nullptr; });
  TangentTable tangents;
  if (has_normal_maps)
    tangents = TangentTable(
        mesh, appearance,
        [&](std::size_t t) -> const UvTransform* {
          const MaterialLook& look = looks[Appearance::material_index(mesh, t)];
          return look.normal_texture ? &look.normal_uv : nullptr;
        },
        progress, memory);
  tables_ = std::make_unique<const Tables>(
      Tables{mesh, appearance, std::move(looks), std::move(tangents)});
}

SurfaceShading::~SurfaceShading() = default;
SurfaceShading::SurfaceShading(SurfaceShading&&) noexcept = default;

SurfaceSample SurfaceShading::mean(std::uint32_t t, std::span<const Vec2f> polygon) const {
  const Tables& tables = *tables_;
  const MaterialLook& look = tables.look(t);
  const bool is_plain = has_one_color(t) && !look.normal_texture;
  if (is_plain && has_one_normal(t)) {
    const Vec3f* const n = tables.normals(t);
    return {look.color, 1, n == nullptr ? face_normal(tables.mesh, t) : n[0]};
  }
  const PolygonMoments moments = polygon_moments(polygon);
  SurfaceSample sample{look.color, 1, tables.mean_normal(t, polygon, moments)};
  if (is_plain) return sample;
  if (!tables.appearance.colors.empty())
    sample.color = sample.color * tables.corner_colors(t)(moments.center);
  if (look.color_texture) {
    const Texture::Value value =
        look.color_texture->mean(region_of(moments, tables.uv(t), look.color_uv));
    float scale = kTexelScale;
    if (look.is_alpha_textured) {
      // The coverages 0 and 1 are exact; the filter may round them.
      sample.coverage = value[3] > 65534.5f ? 1 : value[3] < 0.5f ? 0 : value[3] * kTexelScale;
      scale = sample.coverage > 0 ? 1 / value[3] : 0;
    }
    sample.color = sample.color * Vec3f{value[0] * scale, value[1] * scale, value[2] * scale};
  }
  if (!tables.is_visible(t, look, moments.center)) sample.coverage = 0;
  if (look.normal_texture) {
    const TangentFrames frames = tables.tangents[t];
    if (frames.tangents == nullptr) return sample;
    const Texture::Value value =
        look.normal_texture->mean(region_of(moments, tables.uv(t), look.normal_uv));
    const float agreement = std::sqrt(dot(sample.normal, sample.normal));
    sample.normal = tables.frame_at(t, frames, moments.center)
                        .to_world(Vec3f{unpack_component(value[0]), unpack_component(value[1]),
                                        unpack_component(value[2])} *
                                  agreement);
  }
  return sample;
}

bool SurfaceShading::has_normal_map(std::uint32_t t) const {
  return tables_->look(t).normal_texture != nullptr;
}

bool SurfaceShading::has_one_color(std::uint32_t t) const {
  const MaterialLook& look = tables_->look(t);
  return !look.color_texture && tables_->appearance.colors.empty() && look.least_corner_alpha <= 0;
}

bool SurfaceShading::has_one_normal(std::uint32_t t) const {
  const Vec3f* const n = tables_->normals(t);
  return !tables_->look(t).normal_texture && (n == nullptr || (n[0] == n[1] && n[0] == n[2]));
}

bool SurfaceShading::is_uniform(std::uint32_t t, std::span<const Vec2f> polygon, float color_error,
                                float normal_error, const SurfaceSample& mean) const {
  const Tables& tables = *tables_;
  const MaterialLook& look = tables.look(t);
  if (may_be_alpha_masked(t)) {
    if (mean.coverage == 0) return is_alpha_masked(t, polygon);
    if (tables.corner_alphas(t).first < look.least_corner_alpha) return false;
    if (look.is_alpha_textured &&
        bounds_of(*look.color_texture, polygon, tables.uv(t), look.color_uv).lo[3] < 65535)
      return false;
  }
  return is_near(tables.color_bounds(t, look, polygon), mean.color, color_error) &&
         tables.is_direction_near(t, look, polygon, mean.normal, normal_error);
}

bool SurfaceShading::may_be_uniform(std::uint32_t t, std::span<const Vec2f> polygon,
                                    float color_error, float normal_error) const {
  const Tables& tables = *tables_;
  const MaterialLook& look = tables.look(t);
  if (look.color_texture || !tables.appearance.colors.empty()) {
    const ColorBounds bounds = tables.color_bounds(t, look, polygon);
    for (int c = 0; c < 3; ++c)
      if (linear_to_srgb_fast(bounds.hi[c]) - linear_to_srgb_fast(bounds.lo[c]) > 2 * color_error)
        return false;
  }
  if (!look.normal_texture || tables.tangents[t].tangents == nullptr || normal_error > 1.5f)
    return true;
  const Texture::Bounds texels =
      bounds_of(*look.normal_texture, polygon, tables.uv(t), look.normal_uv);
  Vec3f lo, hi;
  for (unsigned axis = 0; axis < 3; ++axis) {
    lo[static_cast<int>(axis)] = unpack_component(static_cast<float>(texels.lo[axis]));
    hi[static_cast<int>(axis)] = unpack_component(static_cast<float>(texels.hi[axis]));
  }
  return dot(normalized_or(lo, {}), normalized_or(hi, {})) >= std::cos(2 * normal_error) - 1e-5f;
}

bool SurfaceShading::is_alpha_masked(std::uint32_t t, std::span<const Vec2f> polygon) const {
  const Tables& tables = *tables_;
  const MaterialLook& look = tables.look(t);
  if (tables.corner_alphas(t).second < look.least_corner_alpha) return true;
  return look.is_alpha_textured &&
         bounds_of(*look.color_texture, polygon, tables.uv(t), look.color_uv).hi[3] == 0;
}

bool SurfaceShading::may_be_alpha_masked(std::uint32_t t) const {
  const MaterialLook& look = tables_->look(t);
  return look.is_alpha_textured ||
         (look.least_corner_alpha > 0 &&
          (look.least_corner_alpha > 1 || !tables_->appearance.colors.empty()));
}

const Appearance& SurfaceShading::appearance() const { return tables_->appearance; }

std::uint64_t SurfaceShading::bytes() const {
  std::vector<const Texture*> textures;
  for (const MaterialLook& look : tables_->looks) {
    textures.push_back(look.color_texture.get());
    textures.push_back(look.normal_texture.get());
  }
  std::sort(textures.begin(), textures.end());
  textures.erase(std::unique(textures.begin(), textures.end()), textures.end());
  std::uint64_t sum = tables_->tangents.bytes();
  for (const Texture* texture : textures) sum += texture == nullptr ? 0 : texture->bytes();
  return sum;
}

}  // namespace voxdag
