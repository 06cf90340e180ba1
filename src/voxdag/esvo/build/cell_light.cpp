/// The light that is baked into a cell's leaves.
#include <algorithm>
#include <cmath>

#include "voxdag/core/srgb.hpp"
#include "voxdag/esvo/build/cell_builder.hpp"

namespace voxdag {
namespace {

Vec3f with_length_1(Vec3f v, Vec3f otherwise) {
  const float length2 = dot(v, v);
  return length2 > 0 ? v * (1 / std::sqrt(length2)) : otherwise;
}

/// A point of the polygon, well inside.
Vec3d middle_of(const SurfacePolygon& polygon) {
  Vec3d sum{};
  for (int i = 0; i < polygon.count; ++i) sum = sum + polygon.corners[i];
  return sum * (1.0 / polygon.count);
}

}  // namespace

std::optional<float> CellBuilder::light_of(std::size_t begin, int log2_size, Vec3i cell) const {
  // A voxel of the finest level is asked for where most of its surface is; greater ones in the
  // middle of their polygons, too, and near their corners, where light may be another.
  std::size_t largest = begin;
  for (std::size_t i = begin + 1; i < items_.size(); ++i)
    if (area_of(items_[i], 0) > area_of(items_[largest], 0)) largest = i;
  const double half = 0.5 * static_cast<double>(std::int64_t{1} << log2_size);
  const Vec3d centre = static_cast<Vec3d>(origin_ + cell) + Vec3d{half, half, half};
  float least = 1, most = 0;
  double weight_sum = 0, sum = 0;
  const auto ask = [&](SurfacePlace& place, Vec3d local, double weight) {
    place.point = centre + local * half;
    const float light = settings_.light(place);
    least = std::min(least, light);
    most = std::max(most, light);
    sum += weight * static_cast<double>(light);
    weight_sum += weight;
  };
  for (std::size_t i = log2_size == 0 ? largest : begin; i < items_.size(); ++i) {
    const Item& item = items_[i];
    const SurfaceTriangle& triangle = triangles_[item.triangle];
    const auto own = static_cast<Vec3f>(triangle.normal);
    SurfacePlace place;
    place.normal = with_length_1(sample(item, piece(item, log2_size, cell)).normal, {0, 1, 0});
    place.face = dot(own, place.normal) < 0 ? -own : own;
    if (place.face == Vec3f{}) place.face = place.normal;
    const Vec3d middle = middle_of(item.polygon);
    const double weight = area_of(item, log2_size) + 1e-6;
    ask(place, middle, weight);
    if (log2_size == 0) break;
    for (int k = 0; k < item.polygon.count; ++k) {
      ask(place, item.polygon.corners[k] * 0.875 + middle * 0.125, weight);
      if (linear_to_srgb(most) - linear_to_srgb(least) > settings_.color_error) return {};
    }
  }
  return static_cast<float>(sum / weight_sum);
}

bool CellBuilder::put_in_light(std::size_t begin, int log2_size, Vec3i cell,
                               SurfaceSum& sum) const {
  if (!settings_.light || !settings_.attributes || !(sum.area > 0)) return true;
  const std::optional<float> light = light_of(begin, log2_size, cell);
  if (light) sum.color = sum.color * *light;
  return light.has_value();
}

}  // namespace voxdag
