#pragma once
/// The part of a scene that a section keeps: rays see nothing else.
///
/// A section is a box and a half-space, both convex. So it leaves of each ray one interval of T,
/// and rays that are limited to it need no other walk.
#include "voxdag/trace/grid_ray.hpp"

namespace voxdag {

/// In the coordinates of the grid as the cube [1,2]³. By default it keeps everything.
struct RaySection {
  bool is_on = false;
  Vec3f low{1, 1, 1}, high{2, 2, 2};  ///< The box, within the grid.
  /// Keeps the points p with dot(normal, p) <= height; a zero normal keeps all.
  Vec3d normal{};
  double height = 0;
};

namespace detail {

/// Returns T at which the ray enters (is_entry) or leaves the box along `axis`. The ray runs down
/// each axis, mirrored or not; on parallel axes T is far below or beyond all others.
VOXDAG_HD inline float section_side_t(const RaySection& section, const GridRay& ray, int axis,
                                      bool is_entry) {
  const bool is_mirrored = (ray.mirrored >> axis & 1u) != 0;
  const float side = is_entry != is_mirrored ? section.high[axis] : section.low[axis];
  return ray.plane_t(axis, is_mirrored ? 3.0f - side : side);
}

/// Returns how fast the ray approaches the plane, per T, and sets `t` to T at which it is there; t
/// is not finite if the ray runs along the plane.
VOXDAG_HD inline double section_plane_t(const RaySection& section, const GridRay& ray, double& t) {
  double along = 0, left = section.height;
  for (int axis = 0; axis < 3; ++axis) {
    const bool is_mirrored = (ray.mirrored >> axis & 1u) != 0;
    const double at = static_cast<double>(ray.origin[axis]);
    left -= section.normal[axis] * (is_mirrored ? 3 - at : at);
    if ((ray.parallel >> axis & 1u) != 0) continue;
    const double speed = 1 / static_cast<double>(ray.inverse[axis]);
    along += section.normal[axis] * (is_mirrored ? speed : -speed);
  }
  t = along != 0 ? left / along : left < 0 ? -HUGE_VAL : HUGE_VAL;
  return along;
}

}  // namespace detail

/// Limits the ray to the section.
VOXDAG_HD inline void limit_to(const RaySection& section, GridRay& ray) {
  if (!section.is_on || ray.misses()) return;
  float first = ray.t_min, end = end_of_range(ray.t_max);
  for (int axis = 0; axis < 3; ++axis) {
    // A side of the grid itself limits nothing, and a ray may start on it.
    if (section.low[axis] <= 1 && section.high[axis] >= 2) continue;
    const float enter = detail::section_side_t(section, ray, axis, true);
    const float leave = detail::section_side_t(section, ray, axis, false);
    first = enter > first ? enter : first;
    end = leave < end ? leave : end;
  }
  if (dot(section.normal, section.normal) > 0) {
    double t = 0;
    const double along = detail::section_plane_t(section, ray, t);
    const float at = static_cast<float>(t);
    if (along > 0 || (along == 0 && t < 0))
      end = at < end ? at : end;
    else if (along < 0)
      first = at > first ? at : first;
  }
  // At T = end the ray is beyond the last side already.
  ray.t_min = first;
  ray.t_max = first < end ? float_from_bits(bits_of_float(end) - 1) : -1.0f;
}

/// Returns the normal of the side of the section at which the limited ray starts, towards the
/// ray's origin; zero if the ray starts elsewhere.
VOXDAG_HD inline Vec3f cut_normal(const RaySection& section, const GridRay& ray) {
  Vec3f normal{};
  if (!section.is_on) return normal;
  if (dot(section.normal, section.normal) > 0) {
    double t = 0;
    if (detail::section_plane_t(section, ray, t) < 0 && static_cast<float>(t) == ray.t_min)
      return static_cast<Vec3f>(section.normal);
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (section.low[axis] <= 1 && section.high[axis] >= 2) continue;
    if (detail::section_side_t(section, ray, axis, true) != ray.t_min) continue;
    normal[axis] = (ray.mirrored >> axis & 1u) != 0 ? -1.0f : 1.0f;
    return normal;
  }
  return normal;
}

}  // namespace voxdag
