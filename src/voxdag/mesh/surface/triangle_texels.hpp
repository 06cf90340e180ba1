#pragma once
/// Maps polygons in a triangle to texture space.
#include <algorithm>
#include <span>

#include "voxdag/core/vec2.hpp"
#include "voxdag/image/texture.hpp"
#include "voxdag/mesh/appearance.hpp"
#include "voxdag/mesh/surface/polygon_moments.hpp"

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

}  // namespace voxdag
