#pragma once
/// The definition of the cover, as directly as it can be written: does a closed triangle meet a
/// half-open cube? Slow; the builder's own tests (triangle_setup.hpp) are checked against it.
///
/// Source: the separating-axis test of Akenine-Möller, "Fast 3D Triangle-Box Overlap Testing",
/// 2001, in exact integers. The half-open cube [i, i+1) is the closed cube [i, i+1-e] for an
/// infinitesimal e: where an axis has a component that makes the far end of the cube count, a tie
/// separates.
#include "voxdag/core/host_device.hpp"
#include "voxdag/core/int128.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {

namespace detail {

using Wide = Int128;

/// True if the axis (ax, ay, az) separates the triangle from the cube.
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

/// Whether the closed triangle abc contains a point of the half-open cube [lo, lo + size)³. All in
/// one unit; |coordinates| <= 2^30. Degenerate triangles are the segment or point that they are.
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
