#include "voxdag/builders/esvo/build/cell_appearance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "voxdag/builders/pieces/surface_sum.hpp"
#include "voxdag/core/angles.hpp"
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

/// Returns the mean of `light` over the pieces of a cell; there must be at least one. Returns
/// nothing if the cell is larger than a voxel and the light in it varies by more than `color_error`
/// (sRGB encoded).
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

/// Returns whether all points of all triangles in the cell have the same colour and normal.
bool has_one_sample(const Cell& cell) {
  const auto& first = cell.triangle_of(cell.pieces[0]).constant_sample;
  return first &&
         std::all_of(cell.pieces.begin() + 1, cell.pieces.end(), [&](const TrianglePiece& piece) {
           const auto& other = cell.triangle_of(piece).constant_sample;
           return other && other->color == first->color && other->normal == first->normal;
         });
}

}  // namespace

std::optional<float> CellAppearance::light(const Cell& cell, const SurfaceSum& sum) const {
  if (!settings_.light || !settings_.attributes || !(sum.area > 0)) return 1.0f;
  return baked_light(settings_.light, cell, sampler_, settings_.color_error);
}

SurfaceSum CellAppearance::sum(const Cell& cell) const {
  SurfaceSum sum = sum_pieces(cell, sampler_);
  sum.color = sum.color * light(cell, sum).value_or(1.0f);
  return sum;
}

std::optional<SurfaceSum> CellAppearance::sum_if_uniform(const Cell& cell) const {
  std::optional<SurfaceSum> sum = !settings_.attributes || has_one_sample(cell)
                                      ? sum_pieces(cell, sampler_)
                                      : unlit_sum_if_uniform(cell);
  if (!sum) return sum;
  const std::optional<float> arriving = light(cell, *sum);
  if (!arriving) return std::nullopt;
  sum->color = sum->color * *arriving;
  return sum;
}

std::optional<SurfaceSum> CellAppearance::unlit_sum_if_uniform(const Cell& cell) const {
  // SurfaceShading need not compare normals if the triangle uses its plane's normal.
  constexpr float kAnyNormal = 4;  // radians
  const auto normal_error = [&](const SurfaceTriangle& triangle) {
    return sampler_.has_own_normal(triangle) ? kAnyNormal : settings_.normal_error;
  };
  const SurfaceShading* const shading = sampler_.shading();
  PieceCorners few[24];  // most cells have fewer pieces
  std::vector<PieceCorners> many;
  if (cell.pieces.size() > std::size(few)) many.resize(cell.pieces.size());
  PieceCorners* const corners = many.empty() ? few : many.data();
  // Most cells that are not uniform have a piece that is not uniform. For these the mean is not
  // needed.
  for (std::size_t i = 0; i < cell.pieces.size(); ++i) {
    const SurfaceTriangle& triangle = cell.triangle_of(cell.pieces[i]);
    if (triangle.constant_sample) continue;
    corners[i] = sampler_.corners(cell, cell.pieces[i]);
    if (!shading->may_be_uniform(triangle.source, corners[i], settings_.color_error,
                                 normal_error(triangle)))
      return std::nullopt;
  }
  SurfaceSum sum;
  for (std::size_t i = 0; i < cell.pieces.size(); ++i)
    add_piece(sum, cell, cell.pieces[i], sampler_.sample(cell, cell.pieces[i], corners[i]));
  if (!(sum.area > 0)) return std::nullopt;
  const SurfaceSample mean{sum.color * (1 / sum.area), 1, sum.direction() * (1 / sum.area)};
  const auto least_cosine =
      static_cast<float>(cosine_of(std::min(settings_.normal_error, std::numbers::pi_v<float>)));
  const float least = least_cosine * std::sqrt(dot(mean.normal, mean.normal));
  for (std::size_t i = 0; i < cell.pieces.size(); ++i) {
    const SurfaceTriangle& triangle = cell.triangle_of(cell.pieces[i]);
    if (sampler_.has_own_normal(triangle) && triangle.normal != Vec3d{} &&
        dot(static_cast<Vec3f>(triangle.normal), mean.normal) < least)
      return std::nullopt;
    if (shading != nullptr &&
        !shading->is_uniform(triangle.source, corners[i], settings_.color_error,
                             normal_error(triangle), mean))
      return std::nullopt;
  }
  return sum;
}

}  // namespace voxdag
