#include "voxdag/builders/esvo/build/enclose_cell.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <vector>

#include "voxdag/builders/pieces/surface_triangle.hpp"
#include "voxdag/core/parallel/parallel_for.hpp"

namespace voxdag {
namespace {

/// Visits what encloses the triangles of a cell.
class EnclosedCell {
 public:
  EnclosedCell(const TriangleSource& source, int level, Vec3i cell)
      : source_(source),
        log2_size_(source.grid.levels - level),
        origin_(cell * (1 << log2_size_)),
        half_(std::ldexp(0.5, log2_size_)),
        box_(world_box(source.grid, cell, log2_size_)),
        middle_(source.grid.to_world(static_cast<Vec3d>(origin_) + Vec3d{half_, half_, half_})) {}

  /// Adds the directions of a triangle.
  void add_candidates(std::uint32_t triangle, ContourCandidates& candidates) const {
    if (!source_.is_displaced(triangle)) {
      const auto t = SurfaceTriangle::make(source_.mesh.triangle(triangle), origin_, triangle, 0);
      if (t.across.exists()) candidates.add(t.across, dot(polygon(triangle).area(), t.normal));
      return;
    }
    for_each_piece(triangle, HUGE_VAL, [&](const DisplacedPiece& whole) {
      constexpr double kSideOfCell = 4;  // area; a larger triangle is only partly in the cell
      const double voxel = source_.grid.voxel_size;
      const Vec3d area = whole.area() * (1 / (half_ * half_ * voxel * voxel));
      const auto across = ContourDirection::nearest(area);
      if (across.exists())
        candidates.add(across, std::min(std::sqrt(dot(area, area)), kSideOfCell));
    });
  }

  /// Returns the extents of some triangles along the candidates.
  ContourExtents extents(std::span<const std::uint32_t> triangles,
                         const ContourCandidates& candidates) const {
    std::vector<SurfacePolygon> polygons;
    std::vector<PlanarPolygon> surface;
    polygons.reserve(triangles.size());
    surface.reserve(triangles.size());
    for (const std::uint32_t triangle : triangles)
      if (!source_.is_displaced(triangle)) polygons.push_back(polygon(triangle));
    for (const SurfacePolygon& polygon : polygons) surface.push_back({&polygon, {}});
    ContourExtents extents = extents_of(surface, candidates);
    const double size = std::ldexp(source_.grid.voxel_size, log2_size_);
    const auto add = [&](const auto& volume) {
      for (std::size_t i = 0; i < candidates.directions().size(); ++i)
        add_volume(extents[i], candidates.directions()[i].normal, volume);
    };
    for (const std::uint32_t triangle : triangles) {
      if (!source_.is_displaced(triangle)) continue;
      // The known box of a very small triangle is good enough.
      const Box3d& bounds = source_.displaced->displaced_bounds(triangle);
      const Vec3d extent = bounds.hi - bounds.lo;
      if (std::max({extent.x, extent.y, extent.z}) > size / 64)
        for_each_piece(triangle, size / 8, add);
      else
        add(BoxVolume{bounds});
    }
    return extents;
  }

 private:
  struct BoxVolume {
    const Box3d& box;

    Interval along(Vec3d direction) const {
      Interval sum{0, 0};
      for (int axis = 0; axis < 3; ++axis) {
        const Interval part =
            Interval{direction[axis], direction[axis]} * Interval{box.lo[axis], box.hi[axis]};
        sum = {sum.lo + part.lo, sum.hi + part.hi};
      }
      return sum;
    }
  };

  SurfacePolygon polygon(std::uint32_t triangle) const {
    Vec3d corners[3];
    const QuantizedTriangle t = source_.mesh.triangle(triangle);
    for (int i = 0; i < 3; ++i) corners[i] = SurfaceTriangle::corner(t[i], origin_);
    SurfacePolygon polygon = SurfaceTriangle::polygon(corners, {}, log2_size_);
    polygon.clip_to_cell();
    return polygon;
  }

  template <class Body>
  void for_each_piece(std::uint32_t triangle, double small, const Body& body) const {
    source_.displaced->for_each_piece(triangle, box_, source_.edge_limit(), small, body);
  }

  template <class Volume>
  void add_volume(Interval& extent, Vec3i normal, const Volume& volume) const {
    const auto n = static_cast<Vec3d>(normal);
    // Corners of the tessellated surface are rounded to a fraction of a voxel.
    const double margin = length1(normal) / (kSubvoxels * half_);
    const double scale = 1 / (half_ * source_.grid.voxel_size), shift = dot(n, middle_);
    const Interval along = volume.along(n);
    extent.add((along.lo - shift) * scale - margin);
    extent.add((along.hi - shift) * scale + margin);
  }

  const TriangleSource& source_;
  const int log2_size_;
  const Vec3i origin_;
  const double half_;  // of the side, in voxels
  const Box3d box_;
  const Vec3d middle_;  // in world units
};

}  // namespace

ContourCandidates enclosed_candidates(const TriangleSource& source, int level, Vec3i cell,
                                      std::span<const std::uint32_t> triangles) {
  constexpr std::size_t kMaxLookedAt = 1 << 14;
  const std::size_t step = (triangles.size() + kMaxLookedAt - 1) / kMaxLookedAt;
  const EnclosedCell enclosed(source, level, cell);
  ContourCandidates candidates;
  for (std::size_t i = 0; i < triangles.size(); i += step)
    enclosed.add_candidates(triangles[i], candidates);
  return candidates;
}

CellDecision decide_enclosed(const TriangleSource& source, int level, Vec3i cell,
                             std::span<const std::uint32_t> triangles,
                             const ContourCandidates& candidates, ConvexPolyhedron& shape) {
  constexpr std::size_t kChunk = 256;
  const EnclosedCell enclosed(source, level, cell);
  ContourExtents extents;
  std::mutex mutex;
  parallel_for((triangles.size() + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    const std::size_t begin = chunk * kChunk, count = std::min(kChunk, triangles.size() - begin);
    const ContourExtents part = enclosed.extents(triangles.subspan(begin, count), candidates);
    const std::lock_guard lock(mutex);
    for (std::size_t i = 0; i < extents.size(); ++i) {
      extents[i].lo = std::min(extents[i].lo, part[i].lo);
      extents[i].hi = std::max(extents[i].hi, part[i].hi);
    }
  });
  CellDecision decision;
  const std::optional<FittedContour> fitted = fit_contour(shape, candidates, extents);
  if (!fitted || !fitted->pays()) return decision;
  decision.contour = fitted->contour;
  const ConvexPolyhedron whole = shape;
  clip_to_contour(whole, fitted->contour, shape);
  return decision;
}

}  // namespace voxdag
