#include "voxdag/mesh/surface/surface_tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "voxdag/core/angles.hpp"

namespace voxdag {

Vec3f SurfaceTables::mean_normal(std::uint32_t t, std::span<const Vec2f> polygon,
                                 const PolygonMoments& moments) const {
  const Vec3f* const n = normals(t);
  if (n == nullptr) return face_normal(mesh, t);
  if (n[0] == n[1] && n[0] == n[2]) return n[0];
  // This quadrature is exact for polynomials of degree two over a triangle.
  const Linear<Vec3f> normal(n[0], n[1], n[2]);
  Vec3f corners{};
  for (const Vec2f b : polygon) corners = corners + unit_or_zero(normal(b));
  return unit_or_zero(normal(moments.center)) * 0.75f +
         corners * (0.25f / static_cast<float>(polygon.size()));
}

TangentFrame SurfaceTables::frame_at(std::uint32_t t, const CornerTangents& corners,
                                     Vec2f b) const {
  const Vec3f* const n = normals(t);
  const Vec3f normal =
      n == nullptr ? face_normal(mesh, t) : unit_or_zero(Linear<Vec3f>(n[0], n[1], n[2])(b));
  const Vec3f* const p = corners.tangents;
  return make_frame(normal, Linear<Vec3f>(p[0], p[1], p[2])(b), corners.handedness);
}

ColorBounds SurfaceTables::color_bounds(std::uint32_t t, const ResolvedMaterial& material,
                                        std::span<const Vec2f> polygon) const {
  ColorBounds bounds{material.color, material.color};
  if (!appearance.colors.empty()) {
    const Linear<Vec3f> color = corner_colors(t);
    Vec3f lo = color(polygon[0]), hi = lo;
    for (const Vec2f b : polygon.subspan(1)) {
      lo = min(lo, color(b));
      hi = max(hi, color(b));
    }
    bounds = {bounds.lo * max(lo, Vec3f{}), bounds.hi * hi};
  }
  if (material.color_texture) {
    const Texture::Bounds texels =
        bounds_of(*material.color_texture, polygon, uv(t), material.color_uv);
    for (int c = 0; c < 3; ++c) {
      bounds.lo[c] *= static_cast<float>(texels.lo[c]) * kTexelScale;
      bounds.hi[c] *= static_cast<float>(texels.hi[c]) * kTexelScale;
    }
  }
  if (material.emission == Vec3f{}) return bounds;
  ColorBounds emission{material.emission, material.emission};
  if (material.emission_texture) {
    const Texture::Bounds texels =
        bounds_of(*material.emission_texture, polygon, uv(t), material.emission_uv);
    for (int c = 0; c < 3; ++c) {
      emission.lo[c] *= static_cast<float>(texels.lo[c]) * kTexelScale;
      emission.hi[c] *= static_cast<float>(texels.hi[c]) * kTexelScale;
    }
  }
  const Vec3f white{1, 1, 1};
  return {min(bounds.lo + emission.lo, white), min(bounds.hi + emission.hi, white)};
}

bool SurfaceTables::is_direction_near(std::uint32_t t, const ResolvedMaterial& material,
                                      std::span<const Vec2f> polygon, Vec3f direction,
                                      float error) const {
  if (error >= std::numbers::pi_v<float>) return true;
  direction = unit_or_zero(direction);
  const CornerTangents corners = material.normal_texture ? tangents[t] : CornerTangents{};
  if (corners.tangents == nullptr) {
    const auto least = static_cast<float>(cosine_of(error));
    const Vec3f* const n = normals(t);
    if (n == nullptr || (n[0] == n[1] && n[0] == n[2])) {
      const Vec3f normal = n == nullptr ? face_normal(mesh, t) : n[0];
      return normal == Vec3f{} || dot(normal, direction) >= least - 1e-6f;
    }
    // If the normals of the corners lie in a cone narrower than a half-space, so do the
    // interpolated ones.
    if (least <= 0) return false;
    const Linear<Vec3f> normal(n[0], n[1], n[2]);
    return std::all_of(polygon.begin(), polygon.end(), [&](Vec2f b) {
      return dot(unit_or_zero(normal(b)), direction) >= least - 1e-6f;
    });
  }
  const TangentFrame center = frame_at(t, corners, polygon_moments(polygon).center);
  float turn = 0;
  for (const Vec2f b : polygon)
    turn = std::max(turn, angle_between(center, frame_at(t, corners, b)));
  // Inside the polygon a frame may turn slightly more than at its corners.
  const float left = error - 1.25f * turn;
  if (!(left > 0)) return false;
  const auto least = static_cast<float>(cosine_of(std::min(left, 1.5f)));
  const Texture::Bounds texels =
      bounds_of(*material.normal_texture, polygon, uv(t), material.normal_uv);
  const Vec3f local = center.to_local(direction);
  for (unsigned corner = 0; corner < 8; ++corner) {
    Vec3f n;
    for (unsigned axis = 0; axis < 3; ++axis)
      n[static_cast<int>(axis)] = unpack_component(
          static_cast<float>((corner >> axis & 1) != 0 ? texels.hi[axis] : texels.lo[axis]));
    if (!(dot(unit_or_zero(n), local) >= least - 1e-6f)) return false;
  }
  return true;
}

}  // namespace voxdag
