#include "voxdag/builders/esvo/build/cell_appearance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "voxdag/builders/esvo/build/baked_light.hpp"
#include "voxdag/builders/pieces/sum_pieces.hpp"

namespace voxdag {
namespace {

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
  const float least_cosine = std::cos(std::min(settings_.normal_error, std::numbers::pi_v<float>));
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
