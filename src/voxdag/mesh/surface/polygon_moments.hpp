#pragma once
/// The centre and the covariance of convex polygons in the plane.
#include <algorithm>
#include <cmath>
#include <span>

#include "voxdag/core/vec2.hpp"

namespace voxdag {

struct PolygonMoments {
  Vec2f center;
  float xx = 0, xy = 0, yy = 0;  ///< Covariance of the polygon's points.
};

/// Returns the moments of a convex polygon with at least one corner. A polygon without area counts
/// as a segment or a point.
inline PolygonMoments polygon_moments(std::span<const Vec2f> polygon) {
  const Vec2f origin = polygon[0];
  float area = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0, extent = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const Vec2f p = polygon[i - 1] - origin, q = polygon[i] - origin;
    const float a = std::abs(cross(p, q));
    area += a;
    x += a * (p.x + q.x);
    y += a * (p.y + q.y);
    xx += a * (p.x * p.x + p.x * q.x + q.x * q.x);
    xy += a * (2 * (p.x * p.y + q.x * q.y) + p.x * q.y + q.x * p.y);
    yy += a * (p.y * p.y + p.y * q.y + q.y * q.y);
    extent = std::max({extent, p.x * p.x + p.y * p.y, q.x * q.x + q.y * q.y});
  }
  if (area > 1e-5f * extent) {
    const float mx = x / (3 * area), my = y / (3 * area);
    return {origin + Vec2f{mx, my}, std::max(xx / (6 * area) - mx * mx, 0.0f),
            xy / (12 * area) - mx * my, std::max(yy / (6 * area) - my * my, 0.0f)};
  }
  const auto n = static_cast<float>(polygon.size());
  PolygonMoments m;
  for (const Vec2f p : polygon) m.center = m.center + (p - origin) * (1 / n);
  for (const Vec2f p : polygon) {
    const Vec2f d = p - origin - m.center;
    // The variance of a segment's two ends is three times the variance of its points.
    m.xx += d.x * d.x / (3 * n);
    m.xy += d.x * d.y / (3 * n);
    m.yy += d.y * d.y / (3 * n);
  }
  m.center = m.center + origin;
  return m;
}

}  // namespace voxdag
