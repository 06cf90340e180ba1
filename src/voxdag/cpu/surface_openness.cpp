#include "voxdag/cpu/surface_openness.hpp"

#include "voxdag/render/ambient_occlusion.hpp"

namespace voxdag {

SurfaceOpenness::SurfaceOpenness(const VoxelSet& voxels, const Grid& grid, int rays,
                                 double distance)
    : scene_(voxels),
      grid_(grid),
      rays_(rays),
      distance_(static_cast<float>(distance / grid.side())),
      samples_(1, rays) {}

float SurfaceOpenness::operator()(Vec3d point, Vec3f normal, Vec3f face) const {
  return scene_.visit([&](const auto& nodes, const auto& caster) {
    return open_part(nodes, caster, point, normal, face);
  });
}

template <class Nodes, class Caster>
float SurfaceOpenness::open_part(const Nodes& nodes, const Caster& caster, Vec3d point,
                                 Vec3f normal, Vec3f face) const {
  constexpr float kSlack = 0.25f;  // voxels, as for the renderer's rays
  const double lift = static_cast<double>(cube_height(face) + kSlack) * grid_.voxel_size;
  const Vec3d lifted = point + static_cast<Vec3d>(face) * lift;
  SurfacePoint start;
  start.start = make_grid_point(grid_, lifted);
  start.normal = normal;
  start.face = face;
  // In a corner, the point may lie in a voxel of the other surface. Then rays start beside that
  // voxel.
  const auto is_inside = [&] {
    CellHit cell;
    return cast(nodes, make_grid_ray(start.start, face, 0, 0), StopAtVoxels{}, cell);
  };
  const Basis<float> basis = make_basis(face);
  for (int i = 0; i < 8 && is_inside(); ++i) {
    const Vec3f aside = (i & 2) == 0 ? basis.u : basis.v;
    const double step = (i & 1) == 0 ? 1 : -1, cells = i < 4 ? 1 : 2;
    start.start =
        make_grid_point(grid_, lifted + static_cast<Vec3d>(aside) * (step * cells * lift));
  }
  const SampleTables tables = samples_.view();
  int open = 0;
  caster.any(
      rays_, [&](int i) { return occlusion_ray(tables, distance_, 0, start, {}, i); },
      [&](int, bool is_hit) { open += is_hit ? 0 : 1; });
  return static_cast<float>(open) / static_cast<float>(rays_);
}

}  // namespace voxdag
