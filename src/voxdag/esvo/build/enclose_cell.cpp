#include "voxdag/esvo/build/enclose_cell.hpp"

#include "voxdag/core/page_vector.hpp"
#include "voxdag/esvo/build/surface_triangle.hpp"
#include "voxdag/esvo/shape/fit_contour.hpp"

namespace voxdag {
CellDecision decide_enclosed(const TriangleSource& source, int level, Vec3i cell,
                             std::span<const std::uint32_t> triangles, ConvexPolyhedron& shape,
                             MemoryBudget* memory) {
  const Grid& grid = source.grid;
  const int log2_size = grid.levels - level;
  const Box3d box = world_box(grid, cell, log2_size);
  const double half = std::ldexp(0.5, log2_size);
  const Vec3i origin = cell * (1 << log2_size);
  const Vec3d centre = static_cast<Vec3d>(origin) + Vec3d{half, half, half};

  ContourCandidates candidates;
  PageVector<DisplacedPiece> pieces(memory);       // in world units
  CountedVector<SurfacePolygon> polygons(memory);  // in those of the cell
  for (const std::uint32_t triangle : triangles) {
    if (pieces.size() > kMostEnclosed) return {};
    if (!source.is_displaced(triangle)) {
      const auto t = SurfaceTriangle::make(source.mesh.triangle(triangle), origin, triangle, 0);
      polygons.push_back(t.polygon({}, log2_size));
      polygons.back().clip_to_cell();
      if (t.across.exists()) candidates.add(t.across, dot(polygons.back().area(), t.normal));
      continue;
    }
    ContourDirection across;
    source.displaced->for_each_piece(
        triangle, box, source.edge_limit(), std::ldexp(grid.voxel_size, log2_size - 3),
        [&](const DisplacedPiece& piece) {
          const Vec3d area = piece.area() * (1 / (half * half * grid.voxel_size * grid.voxel_size));
          if (!across.exists()) across = ContourDirection::nearest(area);
          if (across.exists()) candidates.add(across, std::sqrt(dot(area, area)));
          pieces.push_back(piece);
        });
  }
  if (pieces.empty() && polygons.empty()) return {};

  CountedVector<PlanarPolygon> surface(memory);
  surface.reserve(polygons.size());
  for (const SurfacePolygon& polygon : polygons) surface.push_back({&polygon, {}});
  ContourExtents extents = extents_of(surface, candidates);
  const Vec3d middle = grid.to_world(centre);
  for (std::size_t i = 0; i < candidates.directions().size(); ++i) {
    const Vec3i normal = candidates.directions()[i].normal;
    const auto n = static_cast<Vec3d>(normal);
    // Corners of the tessellated surface are rounded to a fraction of a voxel.
    const double margin = length1(normal) / (kSubvoxels * half);
    for (const DisplacedPiece& piece : pieces) {
      const Interval along = piece.along(n);
      const double scale = 1 / (half * grid.voxel_size), shift = dot(n, middle);
      extents[i].add((along.lo - shift) * scale - margin);
      extents[i].add((along.hi - shift) * scale + margin);
    }
  }
  CellDecision decision;
  const std::optional<FittedContour> fitted = fit_contour(shape, candidates, extents);
  if (!fitted || !fitted->pays()) return decision;
  decision.contour = fitted->contour;
  const ConvexPolyhedron whole = shape;
  clip_to_contour(whole, fitted->contour, shape);
  return decision;
}

}  // namespace voxdag
