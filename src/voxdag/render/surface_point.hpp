#pragma once
/// The points at which shadow and occlusion rays start.
///
/// Every set voxel contains a point of the surface. So all voxels of a plane with the normal n lie
/// within s = |nx| + |ny| + |nz| <= sqrt(3) voxels of it. A ray that starts higher and runs upwards
/// meets none of them. This holds for cells of any size. A higher start would lose contact shadows,
/// and could lie behind another surface.
#include <cmath>

#include "voxdag/render/render_setup.hpp"
#include "voxdag/render/view_sample.hpp"
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/stop_below_size.hpp"

namespace voxdag {

struct SurfacePoint {
  GridPoint start;    ///< Outside the surface's own cells: rays start here.
  GridPoint surface;  ///< The view sample's point, at which light arrives.
  Vec3f normal{};     ///< Normal of the view sample.
  Vec3f face{};
  float cell_side = 0;  ///< Side of the cell hit, in units of the grid's; 0 where nothing was hit.

  VOXDAG_HD bool is_hit() const { return cell_side > 0; }
};

/// Returns the maximum height of a unit cube's corners above a plane with this normal that meets
/// the cube.
VOXDAG_HD inline float cube_height(Vec3f normal) {
  return std::fabs(normal.x) + std::fabs(normal.y) + std::fabs(normal.z);
}

/// The numbers of is_hidden() and make_surface_point(), in cells.
struct StartRule {
  /// Rays start this far above the cells, because normals are estimates and surfaces bend.
  static constexpr float kSlack = 0.25f;
  static constexpr float kHidden = 4;  ///< A cell this near in front of a point hides it.
  /// Where a point can be moved along the line of sight: the number of tries, and the farthest one.
  static constexpr int kTries = 3, kFarthest = 9;
};

/// Returns whether a cell of the surface's own size lies at the point, or right in front of it as
/// seen by the viewer. `to_viewer` has unit length.
template <class Nodes>
VOXDAG_HD inline bool is_hidden(const Nodes& nodes, const RaySection& section,
                                const SurfacePoint& point, Vec3f to_viewer) {
  GridRay ray = make_grid_ray(point.start, to_viewer, 0, StartRule::kHidden * point.cell_side);
  limit_to(section, ray);
  CellHit cell;
  return cast(nodes, ray, StopBelowSize{point.cell_side, 0, 2}, cell);
}

/// Returns the side, in world units, of the cells that represent a surface at this depth: those at
/// which a primary ray would end.
VOXDAG_HD inline float cell_size_at(const RenderSetup& setup, double depth) {
  const double limit =
      static_cast<double>(setup.settings.lod_pixels) * setup.camera.pixel_size() * depth;
  double size = setup.grid.voxel_size;
  for (int level = setup.grid.levels; level > 2 && size * 2 <= limit; --level) size *= 2;
  return static_cast<float>(size);
}

/// The most casts of make_surface_point(): one from the lifted point, 3 near the line of sight, 2
/// along each axis, and 3 farther along the line of sight.
inline constexpr int kMaxStartCasts = 13;

/// Returns the point for a view sample that hit something and lies on the surface or above it.
/// `line` is the one along which the sample is seen.
template <class Nodes>
VOXDAG_HD inline SurfacePoint make_surface_point(const Nodes& nodes, const RenderSetup& setup,
                                                 const ViewSample& sample, const SightLine& line) {
  SurfacePoint point;
  point.surface = make_grid_point(setup.grid, sample.point);
  point.normal = sample.normal;
  point.face = sample.face;
  const double cell_size =
      static_cast<double>(sample.detail_size > 0 ? sample.detail_size : sample.cell_size);
  point.cell_side = static_cast<float>(cell_size / setup.side());
  const double lift =
      sample.lift > 0
          ? static_cast<double>(sample.lift)
          : static_cast<double>(cube_height(sample.face) + StartRule::kSlack) * cell_size;
  const Vec3d lifted = sample.point + static_cast<Vec3d>(sample.face) * lift;
  const Vec3f to_viewer = -static_cast<Vec3f>(normalized(line.direction));
  const auto can_start_at = [&](Vec3d there) {
    point.start = make_grid_point(setup.grid, there);
    return !is_hidden(nodes, setup.section, point, to_viewer);
  };
  if (can_start_at(lifted)) return point;
  // In corners, in gaps and at the edges of thin objects, that point may lie inside or behind a
  // cell of another surface: the viewer sees the sample, but not the point. So the point is moved
  // along the line of sight, which is free: of voxels everywhere, of a mesh's cells after a few
  // cells.
  const double depth = static_cast<double>(sample.depth);
  const double cell_depth = cell_size / std::sqrt(dot(line.direction, line.direction));
  const auto cells_before = [&](int cells) {
    return line.origin + line.direction * (depth - cells * cell_depth);
  };
  for (int i = 1; i <= StartRule::kTries; ++i)
    if (can_start_at(cells_before(i))) return point;
  // The line of sight may graze the other surface of a corner. Steps along the axes do not; the
  // axis of the longest component comes first.
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
  // In geometry finer than cells, light at a point slightly in front of it is better than no light.
  for (int i = StartRule::kTries + 1; i <= StartRule::kFarthest; i += i / 2)
    if (can_start_at(cells_before(i))) return point;
  return point;
}

}  // namespace voxdag
