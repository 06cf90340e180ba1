#pragma once
/// A ground under the scene that shows only its shadow: it darkens the background.
///
/// A ground sample covers the background by the part of the light that does not arrive, and has no
/// light of its own. So it suits any background, also a transparent one.
#include "voxdag/render/surface_point.hpp"

namespace voxdag {

/// Returns the sample of the ground along the camera's ray, which met nothing else; a sample that
/// is no hit where the ground is not seen.
VOXDAG_HD inline ViewSample ground_view_sample(const RenderSetup& setup, Vec3d direction) {
  const Ground& ground = setup.ground;
  const auto up = static_cast<Vec3d>(setup.sky.up);
  ViewSample sample;
  const double height = dot(setup.camera.eye - ground.middle, up), fall = -dot(direction, up);
  if (!(height > 0 && fall > 0)) return sample;
  const double depth = height / fall;
  const Vec3d point = setup.camera.eye + direction * depth;
  const Vec3d aside = point - ground.middle;
  const double left = 1 - dot(aside, aside) / (ground.radius * ground.radius);
  if (!(left > 0)) return sample;
  sample.point = point;
  sample.normal = sample.face = setup.sky.up;
  sample.depth = static_cast<float>(depth);
  sample.cell_size = cell_size_at(setup, depth);
  sample.ground = static_cast<float>(left * left);
  return sample;
}

/// Returns the start of a ground sample's rays. It may lie outside the grid.
VOXDAG_HD inline SurfacePoint ground_point(const RenderSetup& setup, const ViewSample& sample) {
  SurfacePoint point;
  point.normal = point.face = sample.normal;
  point.cell_side = static_cast<float>(static_cast<double>(sample.cell_size) / setup.side());
  const Vec3d place = (sample.point - setup.grid.origin) * (1 / setup.side());
  for (int axis = 0; axis < 3; ++axis)
    point.surface.position[axis] = static_cast<float>(1 + place[axis]);
  point.start.position = point.surface.position + point.normal * (point.cell_side * 0.25f);
  return point;
}

/// Returns the ray from a view sample's point, as make_grid_ray() for points does.
VOXDAG_HD inline GridRay ray_from(const RenderSetup& setup, const ViewSample& sample,
                                  const SurfacePoint& point, Vec3f direction, float t_min,
                                  float t_max) {
  if (!(sample.ground > 0)) return make_grid_ray(point.start, direction, t_min, t_max);
  const Vec3d start = static_cast<Vec3d>(point.start.position) - Vec3d{1, 1, 1};
  return make_grid_ray(setup.grid, setup.grid.origin + start * setup.side(),
                       static_cast<Vec3d>(direction) * setup.side(), static_cast<double>(t_min),
                       static_cast<double>(t_max));
}

/// Returns how much of the background a ground sample covers. `open` is the part of the sky's light
/// that arrives; `lit` and `unhindered` are the luminance of the lights' irradiance, and the same
/// without occluders.
VOXDAG_HD inline float ground_shadow(const RenderSetup& setup, const ViewSample& sample, float open,
                                     float lit, float unhindered) {
  const float sky = luminance(sky_ambient(setup.sky, sample.normal)) * SkyShape::kOpen;
  const float all = sky + unhindered * kInversePi;
  if (!(all > 0)) return 0;
  return sample.ground * (1 - (sky * open + lit * kInversePi) / all);
}

}  // namespace voxdag
