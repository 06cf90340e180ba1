#include "voxdag/builders/esvo/build/decide_cell.hpp"

#include "voxdag/builders/esvo/shape/fit_contour.hpp"

namespace voxdag {

ContourCandidates contour_candidates(const Cell& cell) {
  const std::size_t step = candidate_step(cell.pieces.size());
  ContourCandidates result;
  for (std::size_t i = 0; i < cell.pieces.size(); i += step) {
    const TrianglePiece& piece = cell.pieces[i];
    const SurfaceTriangle& triangle = cell.triangle_of(piece);
    if (!triangle.across.exists()) {
      // A segment or a point has no normal: uses the axes instead.
      for (int axis = 0; axis < 3; ++axis) {
        Vec3i n{};
        n[axis] = Contour::kMaxNormal;
        result.add(ContourDirection(n), 1e-6);
      }
      continue;
    }
    result.add(triangle.across, piece.area);
    if (triangle.open_edges == 0) continue;
    const SurfacePolygon& polygon = piece.polygon;
    for (int k = 0; k < polygon.count; ++k) {
      const std::uint8_t edge = polygon.edges[k];
      if (edge == SurfacePolygon::kCutEdge || !triangle.across_edges[edge].exists()) continue;
      const Vec3d part = polygon.corners[(k + 1) % polygon.count] - polygon.corners[k];
      result.add(triangle.across_edges[edge], dot(part, part));
    }
  }
  return result;
}

bool CellDecider::is_too_thin(const Cell& cell, const ConvexPolyhedron& shape) {
  constexpr std::size_t kMax = 6;        // with more pieces, such a shape is unlikely
  constexpr double kRounding = 0x1p-10;  // larger than the rounding errors of cutting shapes
  if (cell.pieces.size() > kMax) return false;
  const auto is_thin = [&](const ContourDirection& across) {
    return 2 * extent_of(shape, across.normal).size() <
           (FittedContour::kMinGain - kRounding) * static_cast<double>(across.length);
  };
  Vec3i known{};
  for (const TrianglePiece& piece : cell.pieces) {
    const SurfaceTriangle& triangle = cell.triangle_of(piece);
    if (!triangle.across.exists() || triangle.open_edges != 0) return false;
    if (triangle.across.normal == known) continue;
    known = triangle.across.normal;
    if (!is_thin(triangle.across)) return false;
  }
  return true;
}

void CellDecider::fit(const Cell& cell, ConvexPolyhedron& shape, CellDecision& decision) {
  polygons_.clear();
  for (const TrianglePiece& piece : cell.pieces)
    polygons_.push_back({&piece.polygon, static_cast<Vec3f>(cell.triangle_of(piece).normal)});
  const double error = static_cast<double>(settings_.max_error) / cell.half_size();
  const auto is_near_enough = [&](const ConvexPolyhedron& of) {
    return is_near_surface(of, polygons_, static_cast<float>(error));
  };
  decision.is_near = is_near_enough(shape);
  if (decision.is_near) return;
  const ContourCandidates directions = contour_candidates(cell);
  const std::optional<FittedContour> fitted =
      fit_contour(shape, directions, extents_of(polygons_, directions));
  if (!fitted) return;
  if (cell.log2_size == 0) {
    if (fitted->pays()) decision.contour = fitted->contour;
    return;
  }
  ConvexPolyhedron cut;
  clip_to_contour(shape, fitted->contour, cut);
  decision.is_near = is_near_enough(cut);
  if (!decision.is_near && !fitted->pays()) return;
  decision.contour = fitted->contour;
  shape = cut;
}

CellDecision CellDecider::decide(const Cell& cell, bool is_near, ConvexPolyhedron& shape,
                                 SurfaceSum& sum) {
  CellDecision decision;
  decision.is_near = is_near;
  if (settings_.contours && !is_near) fit(cell, shape, decision);
  if (cell.log2_size == 0) {
    decision.is_leaf = true;
    sum = appearance_.sum(cell);
  } else if (decision.is_near) {
    const std::optional<SurfaceSum> uniform = appearance_.sum_if_uniform(cell);
    decision.is_leaf = uniform.has_value();
    if (uniform) sum = *uniform;
  }
  return decision;
}

}  // namespace voxdag
