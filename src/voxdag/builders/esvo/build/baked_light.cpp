#include "voxdag/builders/esvo/build/baked_light.hpp"

#include <algorithm>
#include <cmath>

#include "voxdag/core/srgb.hpp"

namespace voxdag {
namespace {

/// Returns the mean of a polygon's corners, which lies well inside it.
Vec3d middle_of(const SurfacePolygon& polygon) {
  Vec3d sum{};
  for (int i = 0; i < polygon.count; ++i) sum = sum + polygon.corners[i];
  return sum * (1.0 / polygon.count);
}

SurfacePlace place_on(const Cell& cell, const TrianglePiece& piece, const PieceSampler& sampler) {
  const auto own = static_cast<Vec3f>(cell.triangle_of(piece).normal);
  SurfacePlace place;
  place.normal = normalized_or(sampler.sample(cell, piece).normal, Vec3f{0, 1, 0});
  place.face = dot(own, place.normal) < 0 ? -own : own;
  if (place.face == Vec3f{}) place.face = place.normal;
  return place;
}

/// The weighted mean and the range of the light at some points.
class LightSum {
 public:
  LightSum(const SurfaceLight& light, const Cell& cell) : light_(light), half_(cell.half_size()) {
    centre_ = static_cast<Vec3d>(cell.frame_origin + cell.origin) + Vec3d{half_, half_, half_};
  }

  /// Adds the light at a point in the cell's own coordinates.
  void add(SurfacePlace& place, Vec3d local, double weight) {
    place.point = centre_ + local * half_;
    const float value = light_(place);
    least_ = std::min(least_, value);
    most_ = std::max(most_, value);
    sum_ += weight * static_cast<double>(value);
    weight_ += weight;
  }
  float mean() const { return static_cast<float>(sum_ / weight_); }
  /// Returns the difference between the brightest and the darkest point, sRGB encoded.
  float range() const { return linear_to_srgb(most_) - linear_to_srgb(least_); }

 private:
  const SurfaceLight& light_;
  double half_;
  Vec3d centre_;
  float least_ = 1, most_ = 0;
  double weight_ = 0, sum_ = 0;
};

}  // namespace

std::optional<float> baked_light(const SurfaceLight& light, const Cell& cell,
                                 const PieceSampler& sampler, float color_error) {
  LightSum sum(light, cell);
  if (cell.log2_size == 0) {
    // A voxel of the finest level uses one point: the middle of its largest piece.
    const auto largest = std::max_element(
        cell.pieces.begin(), cell.pieces.end(),
        [](const TrianglePiece& a, const TrianglePiece& b) { return a.area < b.area; });
    SurfacePlace place = place_on(cell, *largest, sampler);
    sum.add(place, middle_of(largest->polygon), cell.area(*largest) + 1e-6);
    return sum.mean();
  }
  for (const TrianglePiece& piece : cell.pieces) {
    SurfacePlace place = place_on(cell, piece, sampler);
    const Vec3d middle = middle_of(piece.polygon);
    const double weight = cell.area(piece) + 1e-6;
    sum.add(place, middle, weight);
    // Light varies most towards the corners.
    for (int k = 0; k < piece.polygon.count; ++k) {
      sum.add(place, piece.polygon.corners[k] * 0.875 + middle * 0.125, weight);
      if (sum.range() > color_error) return std::nullopt;
    }
  }
  return sum.mean();
}

}  // namespace voxdag
