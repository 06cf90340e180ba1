#include "voxdag/esvo/fit_contour.hpp"

#include <algorithm>
#include <cmath>

namespace voxdag {
namespace {

double length2(Vec3i n) {
  const auto v = static_cast<Vec3d>(n);
  return std::sqrt(dot(v, v));
}

struct Extent {
  double low = HUGE_VAL, high = -HUGE_VAL;
  void add(double v) {
    low = v < low ? v : low;
    high = v > high ? v : high;
  }
  double size() const { return high - low; }
};

Extent extent_of(const ConvexPolyhedron& shape, Vec3i normal) {
  const auto n = static_cast<Vec3f>(normal);
  Extent extent;
  for (int i = 0; i < shape.vertex_count(); ++i)
    extent.add(static_cast<double>(dot(n, shape.vertex(i))));
  return extent;
}

Extent extent_of(std::span<const SurfacePolygon* const> surface, Vec3i normal) {
  const auto n = static_cast<Vec3d>(normal);
  Extent extent;
  for (const SurfacePolygon* polygon : surface)
    for (int i = 0; i < polygon->count; ++i) extent.add(dot(n, polygon->corners[i]));
  return extent;
}

}  // namespace

Vec3i quantize_direction(Vec3d direction) {
  const double largest =
      std::max({std::fabs(direction.x), std::fabs(direction.y), std::fabs(direction.z)});
  const Vec3d d = direction * (1 / largest);
  const double length = std::sqrt(dot(d, d));
  Vec3i best{};
  double best_cosine = -1;
  // Longer vectors are finer, but some shorter one may hit the direction better.
  for (int scale = Contour::kMaxNormal; scale > Contour::kMaxNormal / 2; --scale) {
    const Vec3i n{static_cast<std::int32_t>(std::lround(d.x * scale)),
                  static_cast<std::int32_t>(std::lround(d.y * scale)),
                  static_cast<std::int32_t>(std::lround(d.z * scale))};
    const double cosine = dot(static_cast<Vec3d>(n), d) / (length2(n) * length);
    if (cosine > best_cosine + 1e-12) {
      best_cosine = cosine;
      best = n;
    }
  }
  return best;
}

void ContourCandidates::add(Vec3i normal, double weight) {
  constexpr double kLike = 0.98;  // cosine: 11 degrees
  const auto n = static_cast<Vec3d>(normal);
  const double length = length2(normal);
  for (std::size_t i = 0; i < count_; ++i) {
    const double cosine = dot(n, static_cast<Vec3d>(normals_[i])) / (length * length2(normals_[i]));
    if (std::fabs(cosine) < kLike) continue;
    if (weight > weights_[i]) normals_[i] = normal;
    weights_[i] += weight;
    return;
  }
  if (count_ < kMost) {
    normals_[count_] = normal;
    weights_[count_++] = weight;
    return;
  }
  const auto lightest = static_cast<std::size_t>(
      std::min_element(weights_.begin(), weights_.end()) - weights_.begin());
  if (weights_[lightest] >= weight) return;
  normals_[lightest] = normal;
  weights_[lightest] = weight;
}

std::optional<FittedContour> fit_contour(const ConvexPolyhedron& shape,
                                         std::span<const SurfacePolygon* const> surface,
                                         const ContourCandidates& candidates) {
  // In steps of the stored positions.
  constexpr double kMargin = 0.01;
  if (shape.is_empty()) return std::nullopt;
  Vec3i best{};
  Extent best_surface, best_shape;
  double most = 0;
  for (const Vec3i normal : candidates.normals()) {
    const Extent of_surface = extent_of(surface, normal), of_shape = extent_of(shape, normal);
    const double over = (of_shape.size() - of_surface.size()) / length2(normal);
    if (!(over > most)) continue;
    most = over;
    best = normal;
    best_surface = of_surface;
    best_shape = of_shape;
  }
  if (!(most > 0)) return std::nullopt;

  // position = |n|1 (2p - 127) / 127
  const double n1 = length1(best);
  constexpr int kMax = Contour::kMaxPosition;
  constexpr double kSteps = kMax;
  const auto step_of = [&](double position) { return (position / n1 + 1) * (kSteps / 2); };
  const int low =
      std::clamp(static_cast<int>(std::floor(step_of(best_surface.low) - kMargin)), 0, kMax);
  const int high =
      std::clamp(static_cast<int>(std::ceil(step_of(best_surface.high) + kMargin)), 0, kMax);
  FittedContour fitted;
  // Of the two that mean the same the one that points up, so that equal ones can be shared.
  const bool points_up = best.z != 0 ? best.z > 0 : best.y != 0 ? best.y > 0 : best.x > 0;
  fitted.contour =
      points_up ? Contour::make(best, low, high) : Contour::make(-best, kMax - high, kMax - low);
  Extent planes;
  planes.add(std::max(contour_position<double>(length1(best), low), best_shape.low));
  planes.add(std::min(contour_position<double>(length1(best), high), best_shape.high));
  const double length = length2(best);
  fitted.gain = (best_shape.size() - planes.size()) / length;
  return fitted;
}

void clip_to_contour(ConvexPolyhedron& shape, Contour contour) {
  const Vec3i n = contour.normal();
  shape.clip(static_cast<Vec3f>(n), contour_position<float>(length1(n), contour.high()));
  shape.clip(static_cast<Vec3f>(-n), -contour_position<float>(length1(n), contour.low()));
}

}  // namespace voxdag
