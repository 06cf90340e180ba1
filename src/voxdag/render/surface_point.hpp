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
  GridPoint start;  ///< Clear of the surface's own cells.
  Vec3f normal{};   ///< As of the view sample.
  Vec3f face{};
  float cell_side = 0;  ///< Of the cell met, in units of the grid's side; 0 where nothing is.

  VOXDAG_HD bool is_hit() const { return cell_side > 0; }
};

/// How far the corner of a unit cube lies at most above a plane with this normal that meets it.
VOXDAG_HD inline float cube_height(Vec3f normal) {
  return std::fabs(normal.x) + std::fabs(normal.y) + std::fabs(normal.z);
}

/// Whether a cell with at most this side, in units of the grid's, lies at the point.
template <class Nodes>
VOXDAG_HD inline bool is_occupied(const Nodes& nodes, GridPoint point, float cell_side) {
  const GridRay ray = make_grid_ray(point, {1, 0, 0}, 0, 0);
  CellHit cell;
  return cast(nodes, ray, StopBelowSize{cell_side, 0, 2}, cell);
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

/// `sample` is hit, and its point lies on its surface or above.
template <class Nodes>
VOXDAG_HD inline SurfacePoint make_surface_point(const Nodes& nodes, const RenderSetup& setup,
                                                 const ViewSample& sample) {
  constexpr float kSlack = 0.25f;  // cells: normals are estimates, surfaces bend
  SurfacePoint point;
  point.normal = sample.normal;
  point.face = sample.face;
  const double cell_size = static_cast<double>(sample.cell_size);
  point.cell_side = static_cast<float>(cell_size / setup.side());
  const double lift = static_cast<double>(cube_height(sample.face) + kSlack);
  Vec3d start = sample.point + static_cast<Vec3d>(sample.face) * (lift * cell_size);
  point.start = make_grid_point(setup.grid, start);
  // In the corner between two surfaces that may still be inside a cell of the other one. The way to
  // the viewer leads out of it.
  constexpr int kTries = 2;
  const Vec3d to_viewer = setup.camera.eye - sample.point;
  for (int i = 0; i < kTries && is_occupied(nodes, point.start, point.cell_side); ++i) {
    start = start + to_viewer * (cell_size / std::sqrt(dot(to_viewer, to_viewer)));
    point.start = make_grid_point(setup.grid, start);
  }
  return point;
}

}  // namespace voxdag
