#pragma once
/// The definition of the exact cover in its most direct form: whether a closed triangle meets a
/// half-open cube. Slow: the reference for the builders' tests (triangle_setup.hpp).
///
/// Source: the separating-axis test of Akenine-Möller, "Fast 3D Triangle-Box Overlap Testing",
/// 2001, in exact integers. The half-open cube [i, i+1) is the closed cube [i, i+1-e] for an
/// infinitesimal e. So if the extreme point of the cube along an axis lies on an upper side,
/// equality separates.
#include "voxdag/core/host_device.hpp"
#include "voxdag/core/int128.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {

namespace detail {

using Wide = Int128;

/// Returns whether the axis (ax, ay, az) separates the triangle from the cube.
VOXDAG_HD inline bool separates(Wide ax, Wide ay, Wide az, Vec3i a, Vec3i b, Vec3i c, Vec3l lo,
                                std::int64_t size) {
  const Wide pa = ax * a.x + ay * a.y + az * a.z;
  const Wide pb = ax * b.x + ay * b.y + az * b.z;
  const Wide pc = ax * c.x + ay * c.y + az * c.z;
  const Wide triangle_min = pa < pb ? (pa < pc ? pa : pc) : (pb < pc ? pb : pc);
  const Wide triangle_max = pa > pb ? (pa > pc ? pa : pc) : (pb > pc ? pb : pc);
  Wide cube_min = ax * lo.x + ay * lo.y + az * lo.z, cube_max = cube_min;
  bool min_attained = true, max_attained = true;
  const Wide components[3] = {ax, ay, az};
  for (const Wide component : components) {
    if (component > 0) {
      cube_max += component * size;
      max_attained = false;
    } else if (component < 0) {
      cube_min += component * size;
      min_attained = false;
    }
  }
  return (max_attained ? triangle_min > cube_max : triangle_min >= cube_max) ||
         (min_attained ? triangle_max < cube_min : triangle_max <= cube_min);
}

}  // namespace detail

/// Returns whether the closed triangle abc contains a point of the half-open cube [lo, lo + size)³.
/// All values are in one unit; |coordinates| <= 2^30. A triangle without area counts as a segment
/// or a point.
VOXDAG_HD inline bool triangle_overlaps_cube(Vec3i a, Vec3i b, Vec3i c, Vec3l lo,
                                             std::int64_t size) {
  using detail::separates;
  const auto difference = [](Vec3i to, Vec3i from) {
    return static_cast<Vec3l>(to) - static_cast<Vec3l>(from);
  };
  const Vec3l edges[3] = {difference(b, a), difference(c, b), difference(a, c)};
  for (int i = 0; i < 3; ++i)
    if (separates(i == 0, i == 1, i == 2, a, b, c, lo, size)) return false;
  const Vec3l normal = cross(edges[0], edges[1]);
  if (separates(normal.x, normal.y, normal.z, a, b, c, lo, size)) return false;
  for (const Vec3l& edge : edges) {
    if (separates(0, edge.z, -edge.y, a, b, c, lo, size)) return false;
    if (separates(-edge.z, 0, edge.x, a, b, c, lo, size)) return false;
    if (separates(edge.y, -edge.x, 0, a, b, c, lo, size)) return false;
  }
  return true;
}

}  // namespace voxdag
