#include "voxdag/builders/pieces/piece_sampler.hpp"

#include <array>

namespace voxdag {

std::optional<SurfaceSample> PieceSampler::constant_sample(const SurfaceTriangle& triangle) const {
  const auto own_normal = static_cast<Vec3f>(triangle.normal);
  if (shading_ == nullptr) return SurfaceSample{kSurfaceGrey, 1, own_normal};
  if (!shading_->has_one_color(triangle.source) ||
      !(triangle.is_displaced || !with_normals_ || shading_->has_one_normal(triangle.source)))
    return std::nullopt;
  SurfaceSample sample = shading_->mean(
      triangle.source, std::array<Vec2f, 1>{Vec2f{1.0f / 3, 1.0f / 3}}, with_normals_);
  if (triangle.is_displaced) sample.normal = own_normal;
  return sample;
}

PieceCorners PieceSampler::corners(const Cell& cell, const TrianglePiece& piece) const {
  PieceCorners corners;
  const SurfaceTriangle& triangle = cell.triangle_of(piece);
  if (triangle.constant_sample) return corners;
  const double half = cell.half_size();
  const Vec3d centre = cell.centre();
  corners.count = static_cast<std::size_t>(piece.polygon.count);
  for (int i = 0; i < piece.polygon.count; ++i)
    corners.points[i] = triangle.barycentric(centre + piece.polygon.corners[i] * half);
  return corners;
}

SurfaceSample PieceSampler::sample(const Cell& cell, const TrianglePiece& piece,
                                   const PieceCorners& corners) const {
  const SurfaceTriangle& triangle = cell.triangle_of(piece);
  if (triangle.constant_sample) return *triangle.constant_sample;
  SurfaceSample sample = shading_->mean(triangle.source, corners, with_normals_);
  if (triangle.is_displaced) sample.normal = static_cast<Vec3f>(triangle.normal);
  return sample;
}

bool PieceSampler::is_alpha_masked(const Cell& cell, const TrianglePiece& piece) const {
  if (shading_ == nullptr) return false;
  const std::uint32_t source = cell.triangle_of(piece).source;
  return shading_->may_be_alpha_masked(source) &&
         shading_->is_alpha_masked(source, corners(cell, piece));
}

}  // namespace voxdag
