#pragma once
/// A ray in the coordinates of the traversal, and the exact definition of the voxels that it meets.
///
/// Coordinates. The grid is the cube [1,2]³, so that the bits of a coordinate's mantissa are the
/// child indices of the cells that contain the point (Laine and Karras, "Efficient Sparse Voxel
/// Octrees", I3D 2010, section 4.1). Axes along which the ray runs up are mirrored (p -> 3 - p), so
/// that the ray runs down along every axis. Its origin is a multiple of 2^-23 in [1,2]. Its
/// parameter T is 0 at the origin, and grows by 1 while the ray crosses the grid along its dominant
/// axis.
///
/// The plane rule. The ray meets the plane p of an axis at
///     T(p) = (origin - p) * inverse                                     (plane_t below)
/// in float arithmetic. Origin and p are multiples of 2^-23 in [1,2], so the difference is exact.
/// The product with a positive constant is rounded once, correctly. Rounding is monotone, so T(p)
/// never decreases as p falls. From one voxel plane to the next it even increases strictly:
/// neighbouring differences are at least 2^-20 apart and at most 1, a ratio of more than 1 + 2^-21,
/// while rounding changes a product by at most a factor of 1 +- 2^-24. No sum follows the product,
/// so no compiler can contract it, and every machine finds the same T.
///
/// The voxel rule. At T the ray is, along each axis, beyond exactly the planes with T(p) <= T. This
/// defines one voxel for every T, and one cell of every coarser level. The planes of coarser cells
/// are a subset of the voxels' planes, so a walk of the octree visits the same voxels as a walk of
/// the grid. The ray meets the voxels that it is in at some T in [t_min, t_max], both ends
/// included. If it crosses several planes at one T (an edge or a corner, to float precision), it
/// passes to the diagonal neighbour and meets none of the voxels between. A ray that starts on a
/// plane is in the voxel ahead.
///
/// Parallel axes. Inside the grid, a direction component below 2^-32 of the largest counts as zero:
/// it would move the ray by less than 2^-32 of the grid. If such a ray enters the grid at p, it
/// stays in the voxels with floor(p) for all T: the rule of the half-open voxel. It never enters
/// through a face of that axis. Outside the grid even the smallest component counts, so that a ray
/// that starts far away enters the grid where its line does.
///
/// Precision. The origin is rounded once, by up to 2^-24 of the grid (1/128 voxel at 131,072³); all
/// rays of a camera inside the grid get the same origin. From there on, T has two rounding errors,
/// 2^-23 of the distance. A ray that starts outside is restarted where it enters the grid, in
/// double. If it starts D grids away, its error there is up to D * 2^-51 of the grid.
#include <cmath>
#include <cstdint>

#include "voxdag/core/bits.hpp"
#include "voxdag/core/grid.hpp"
#include "voxdag/trace/ray.hpp"

namespace voxdag {

/// Made by make_grid_ray. A ray with t_min > t_max meets nothing.
struct GridRay {
  Vec3f origin{1, 1, 1};       ///< In [1,2], mirrored.
  Vec3f inverse{1, 1, 1};      ///< 1 / |component| of the direction; 2^32 on parallel axes.
  float t_min = 1, t_max = 0;  ///< The range of T; t_min >= 0.
  std::uint32_t mirrored = 7;  ///< Bit a: axis a is mirrored (the ray runs up or is parallel).
  std::uint32_t parallel = 0;  ///< Bit a: the ray does not move along axis a.
  double t_start = 0;          ///< The parameter t of the world ray at T = 0.
  double t_scale = 1;          ///< Growth of t as T grows by 1.

  VOXDAG_HD bool misses() const { return !(t_min <= t_max); }

  /// Returns T at the plane `position` (mirrored, a multiple of 2^-23 in [1,2]) of `axis`.
  VOXDAG_HD float plane_t(int axis, float position) const {
    return (origin[axis] - position) * inverse[axis];
  }

  /// Returns T at which the ray leaves the grid.
  VOXDAG_HD float exit_t() const {
    const float x = plane_t(0, 1), y = plane_t(1, 1), z = plane_t(2, 1);
    const float xy = x < y ? x : y;
    return xy < z ? xy : z;
  }

  /// Returns the world ray's parameter t at T = grid_t.
  VOXDAG_HD double to_world_t(double grid_t) const { return std::fma(grid_t, t_scale, t_start); }
};

/// Returns the least float above t_max >= 0: T is less than it if and only if T <= t_max.
VOXDAG_HD inline float end_of_range(float t_max) {
  return t_max < HUGE_VALF ? float_from_bits(bits_of_float(t_max) + 1) : t_max;
}

/// Converts the ray origin + t * direction, t_min <= t <= t_max, from world units to the form of
/// the traversal. The origin may lie anywhere; t_min and t_max are rounded to nearest in T.
VOXDAG_HD inline GridRay make_grid_ray(const Grid& grid, Vec3d world_origin, Vec3d world_direction,
                                       double t_min, double t_max) {
  constexpr double kInfinity = HUGE_VAL;
  constexpr double kParallel = 0x1p-32;
  constexpr double kZero = 0x1p-960;  // smaller values have no finite inverse, or almost none
  GridRay ray;
  if (!(t_min <= t_max)) return ray;

  // The grid as [0,1]³, the direction with its largest component 1.
  const double to_unit = 1.0 / grid.side();
  const Vec3d start = (world_origin - grid.origin) * to_unit;
  Vec3d direction = world_direction * to_unit;
  double length = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double size = std::fabs(direction[axis]);
    if (!(size < kInfinity) || !(std::fabs(start[axis]) < kInfinity)) return ray;
    length = length < size ? size : length;
  }
  ray.t_scale = 1.0 / length;
  if (!(length > 0) || !(ray.t_scale < kInfinity)) return ray;
  direction = direction * ray.t_scale;

  // The t at which the line enters and leaves the grid, and the axis of the entered side.
  double enter = (t_min < 0 ? t_min : 0.0) * length, leave = kInfinity;
  int enter_axis = -1;
  ray.mirrored = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = direction[axis], p = start[axis];
    const bool is_parallel = std::fabs(d) < kParallel;
    if (is_parallel) {
      ray.parallel |= 1u << axis;
      ray.mirrored |= 1u << axis;
      ray.inverse[axis] = 0x1p32f;
    }
    if (std::fabs(d) < kZero) {
      if (!(p >= 0 && p < 1)) return ray;
      continue;
    }
    const double inverse = 1.0 / d;
    const double near = ((d > 0 ? 0.0 : 1.0) - p) * inverse;
    const double far = ((d > 0 ? 1.0 : 0.0) - p) * inverse;
    if (near > enter) {
      enter = near;
      enter_axis = axis;
    }
    leave = far < leave ? far : leave;
    if (is_parallel) continue;
    ray.mirrored |= d > 0 ? 1u << axis : 0u;
    ray.inverse[axis] = static_cast<float>(std::fabs(inverse));
  }
  if (!(enter <= leave && enter < kInfinity)) return ray;

  for (int axis = 0; axis < 3; ++axis) {
    const bool up = (ray.mirrored >> axis & 1u) != 0;
    const bool still = (ray.parallel >> axis & 1u) != 0;
    double p = start[axis];
    if (axis == enter_axis)
      p = direction[axis] > 0 ? 0.0 : 1.0;
    else if (enter != 0)
      p = std::fma(enter, direction[axis], p);
    if (still && p >= 1 && direction[axis] > 0) return ray;  // it only touches the grid
    p = p < 0 ? 0.0 : p > 1 ? 1.0 : p;
    float q = static_cast<float>(1.0 + p);
    // Rounding must not carry a ray out of the grid along an axis on which it does not move.
    if (still && q > 2 - 0x1p-23f) q = 2 - 0x1p-23f;
    ray.origin[axis] = up ? 3.0f - q : q;
  }
  ray.t_start = enter * ray.t_scale;
  const double first = t_min * length - enter;
  ray.t_min = first > 0 ? static_cast<float>(first) : 0.0f;
  ray.t_max = static_cast<float>(t_max * length - enter) + 0.0f;  // not -0, for end_of_range()
  return ray;
}

VOXDAG_HD inline GridRay make_grid_ray(const Grid& grid, const Ray& ray) {
  return make_grid_ray(grid, static_cast<Vec3d>(ray.origin), static_cast<Vec3d>(ray.direction),
                       static_cast<double>(ray.t_min), static_cast<double>(ray.t_max));
}

/// A point in the grid in the form of the traversal: rounded once, for all rays that start there.
struct GridPoint {
  Vec3f position{1, 1, 1};  ///< The grid is [1,2]³; multiples of 2^-23.
};

/// Returns the nearest point of the closed grid, rounded by up to 2^-24 of its side. NaN counts as
/// 0.
VOXDAG_HD inline GridPoint make_grid_point(const Grid& grid, Vec3d world) {
  const double to_unit = 1.0 / grid.side();
  GridPoint point;
  for (int axis = 0; axis < 3; ++axis) {
    const double p = (world[axis] - grid.origin[axis]) * to_unit;
    point.position[axis] = static_cast<float>(1.0 + (p > 0 ? (p < 1 ? p : 1.0) : 0.0));
  }
  return point;
}

/// Returns the ray start + t * direction, 0 <= t_min <= t <= t_max. The direction is in units of
/// the grid's side and need not have unit length; t is in units of the direction. Computes in
/// float: for the many short rays of one point. A ray with a zero direction meets nothing.
VOXDAG_HD inline GridRay make_grid_ray(const GridPoint& start, Vec3f direction, float t_min,
                                       float t_max) {
  constexpr float kParallel = 0x1p-32f;
  GridRay ray;
  const float ax = std::fabs(direction.x), ay = std::fabs(direction.y), az = std::fabs(direction.z);
  const float axy = ax > ay ? ax : ay;
  const float length = axy > az ? axy : az;
  if (!(length > 0 && length < HUGE_VALF)) return ray;
  ray.mirrored = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float d = direction[axis], p = start.position[axis];
    const bool still = !(std::fabs(d) >= kParallel * length);
    const bool up = still || d > 0;
    // A ray that does not move along an axis is in the voxels with floor(origin); rounding must not
    // move it out of the grid.
    const float q = still && p > 2 - 0x1p-23f ? 2 - 0x1p-23f : p;
    ray.parallel |= still ? 1u << axis : 0u;
    ray.mirrored |= up ? 1u << axis : 0u;
    ray.origin[axis] = up ? 3.0f - q : q;
    ray.inverse[axis] = still ? 0x1p32f : length / std::fabs(d);
  }
  ray.t_scale = 1.0 / static_cast<double>(length);
  ray.t_min = t_min * length;
  ray.t_max = t_max * length + 0.0f;  // not -0, for end_of_range()
  return ray;
}

}  // namespace voxdag
