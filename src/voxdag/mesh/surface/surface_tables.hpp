#pragma once
/// The data behind SurfaceShading: materials, textures and tangents, looked up by triangle.
#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "voxdag/core/vec2.hpp"
#include "voxdag/image/texture.hpp"
#include "voxdag/mesh/appearance.hpp"
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/mesh/surface/material_textures.hpp"
#include "voxdag/mesh/surface/polygon_moments.hpp"
#include "voxdag/mesh/surface/tangent_frames.hpp"

namespace voxdag {

/// A value that is linear over a triangle: v + b1 * d1 + b2 * d2 at barycentric coordinates
/// (b1, b2).
template <class T>
struct Linear {
  T v, d1, d2;

  Linear(const T& v0, const T& v1, const T& v2) : v(v0), d1(v1 - v0), d2(v2 - v0) {}
  T operator()(Vec2f b) const { return v + d1 * b.x + d2 * b.y; }
};

/// Returns the centre and the covariance, in texture coordinates, of a polygon with these moments.
inline UvRegion region_of(const PolygonMoments& m, const Linear<Vec2f>& uv,
                          const UvTransform& transform) {
  const Vec2f a = transform.linear(uv.d1), b = transform.linear(uv.d2);
  return {transform(uv(m.center)), a.x * a.x * m.xx + 2 * a.x * b.x * m.xy + b.x * b.x * m.yy,
          a.x * a.y * m.xx + (a.x * b.y + b.x * a.y) * m.xy + b.x * b.y * m.yy,
          a.y * a.y * m.xx + 2 * a.y * b.y * m.xy + b.y * b.y * m.yy};
}

struct UvBox {
  Vec2f lo, hi;
};

/// Returns the bounding box, in texture coordinates, of a polygon given by barycentric coordinates.
inline UvBox box_of(std::span<const Vec2f> polygon, const Linear<Vec2f>& uv,
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

/// Returns bounds on the texels that a polygon may show.
inline Texture::Bounds bounds_of(const Texture& texture, std::span<const Vec2f> polygon,
                                 const Linear<Vec2f>& uv, const UvTransform& transform) {
  const UvBox box = box_of(polygon, uv, transform);
  return texture.bounds(box.lo, box.hi);
}

/// The factor from texels to values from 0 to 1.
inline constexpr float kTexelScale = 1.0f / 65535;

/// Bounds on colours, in linear light.
struct ColorBounds {
  Vec3f lo, hi;
};

/// Refers to mesh and appearance. Immutable and thread-safe. Polygons are given as in
/// SurfaceShading.
struct SurfaceTables {
  const Mesh& mesh;
  const Appearance& appearance;
  std::vector<ResolvedMaterial> materials;  ///< At least one.
  TangentTable tangents;

  const ResolvedMaterial& material(std::uint32_t t) const {
    return materials[Appearance::material_index(mesh, t)];
  }
  Linear<Vec2f> uv(std::uint32_t t) const {
    const Vec2f* const p = appearance.uvs.data() + 3 * std::size_t{t};
    return {p[0], p[1], p[2]};
  }
  /// Returns the corners' normals; null if the triangle has the normal of its plane.
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
  /// Returns whether the corners' alpha passes the alpha test at a point.
  bool is_visible(std::uint32_t t, const ResolvedMaterial& material, Vec2f b) const {
    if (material.least_corner_alpha <= 0) return true;
    if (appearance.colors.empty()) return material.least_corner_alpha <= 1;
    const Rgba16* const c = appearance.colors.data() + 3 * std::size_t{t};
    return Linear<float>(c[0].alpha(), c[1].alpha(), c[2].alpha())(b) >=
           material.least_corner_alpha;
  }

  /// Returns the mean of the unit normals over a polygon, without the normal map.
  Vec3f mean_normal(std::uint32_t t, std::span<const Vec2f> polygon,
                    const PolygonMoments& moments) const;
  TangentFrame frame_at(std::uint32_t t, const CornerTangents& corners, Vec2f b) const;
  /// Returns bounds on the colours in a polygon.
  ColorBounds color_bounds(std::uint32_t t, const ResolvedMaterial& material,
                           std::span<const Vec2f> polygon) const;
  /// Returns true only if the normal of every point of a polygon is within `error` radians of
  /// `direction`.
  bool is_direction_near(std::uint32_t t, const ResolvedMaterial& material,
                         std::span<const Vec2f> polygon, Vec3f direction, float error) const;
};

}  // namespace voxdag
