#pragma once
/// Where the rays of shadow and occlusion start.
///
/// The cover is conservative: a set voxel contains a point of the surface. So for a plane with the
/// normal n all of its voxels lie within s = |nx| + |ny| + |nz| <= sqrt(3) voxels of it, and a ray
/// that starts higher and runs upwards meets none of them. The same holds for cells of any size.
/// Starting any higher would cost contact shadows, and could come out behind another surface.
#include <cmath>

#include "voxdag/render/render_setup.hpp"
#include "voxdag/render/view_sample.hpp"
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/stop_below_size.hpp"

namespace voxdag {

struct SurfacePoint {
  GridPoint start;    ///< Clear of the surface's own cells.
  GridPoint surface;  ///< As of the view sample: what light arrives at.
  Vec3f normal{};     ///< Likewise.
  Vec3f face{};
  float cell_side = 0;  ///< Of the cell met, in units of the grid's side; 0 where nothing is.

  VOXDAG_HD bool is_hit() const { return cell_side > 0; }
};

/// How far the corner of a unit cube lies at most above a plane with this normal that meets it.
VOXDAG_HD inline float cube_height(Vec3f normal) {
  return std::fabs(normal.x) + std::fabs(normal.y) + std::fabs(normal.z);
}

/// Whether a cell of the surface's own size lies at the point or right before it, as the viewer
/// sees it. `to_viewer` has unit length.
template <class Nodes>
VOXDAG_HD inline bool is_hidden(const Nodes& nodes, const SurfacePoint& point, Vec3f to_viewer) {
  constexpr float kCells = 4;
  const GridRay ray = make_grid_ray(point.start, to_viewer, 0, kCells * point.cell_side);
  CellHit cell;
  return cast(nodes, ray, StopBelowSize{point.cell_side, 0, 2}, cell);
}

/// The side of the cells, in world units, that stand for a surface at this depth: those at which a
/// primary ray would end there.
VOXDAG_HD inline float cell_size_at(const RenderSetup& setup, double depth) {
  const double limit =
      static_cast<double>(setup.settings.lod_pixels) * setup.camera.pixel_size() * depth;
  double size = setup.grid.voxel_size;
  for (int level = setup.grid.levels; level > 2 && size * 2 <= limit; --level) size *= 2;
  return static_cast<float>(size);
}

/// `sample` is hit, and its point lies on its surface or above. `direction` is that of the camera's
/// ray to it.
template <class Nodes>
VOXDAG_HD inline SurfacePoint make_surface_point(const Nodes& nodes, const RenderSetup& setup,
                                                 const ViewSample& sample, Vec3d direction) {
  constexpr float kSlack = 0.25f;  // cells: normals are estimates, surfaces bend
  SurfacePoint point;
  point.surface = make_grid_point(setup.grid, sample.point);
  point.normal = sample.normal;
  point.face = sample.face;
  const double cell_size =
      static_cast<double>(sample.detail_size > 0 ? sample.detail_size : sample.cell_size);
  point.cell_side = static_cast<float>(cell_size / setup.side());
  const double lift = sample.lift > 0
                          ? static_cast<double>(sample.lift)
                          : static_cast<double>(cube_height(sample.face) + kSlack) * cell_size;
  const Vec3d lifted = sample.point + static_cast<Vec3d>(sample.face) * lift;
  const Vec3f to_viewer = -static_cast<Vec3f>(normalized(direction));
  const auto can_start_at = [&](Vec3d there) {
    point.start = make_grid_point(setup.grid, there);
    return !is_hidden(nodes, point, to_viewer);
  };
  if (can_start_at(lifted)) return point;
  // In a corner, in a gap, at the edge of something thin that may be inside or behind a cell of
  // another surface: the viewer sees the sample, but not that point. What the viewer looks along is
  // free, for voxels at once and for a mesh when its cells are left.
  constexpr int kTries = 3, kFarthest = 9;  // cells
  const double depth = static_cast<double>(sample.depth);
  const double cell_depth = cell_size / std::sqrt(dot(direction, direction));
  const auto cells_before = [&](int cells) {
    return setup.camera.eye + direction * (depth - cells * cell_depth);
  };
  for (int i = 1; i <= kTries; ++i)
    if (can_start_at(cells_before(i))) return point;
  // That way may all but graze the other surface of a corner. The steps along the axes that it is
  // made of, the longest first, do not.
  Vec3f left = to_viewer;
  for (int i = 0; i < 3; ++i) {
    const Vec3f size{std::fabs(left.x), std::fabs(left.y), std::fabs(left.z)};
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    for (int cells = 1; cells <= 2; ++cells) {
      Vec3d there = lifted;
      there[axis] += (left[axis] < 0 ? -cells : cells) * cell_size;
      if (can_start_at(there)) return point;
    }
    left[axis] = 0;
  }
  // Deep in what is finer than cells: light from a little before it is nearer to its own than none.
  for (int i = kTries + 1; i <= kFarthest; i += i / 2)
    if (can_start_at(cells_before(i))) return point;
  return point;
}

}  // namespace voxdag
