#pragma once
/// The reference for ray casts: voxel sets without any tree, and walks that visit every voxel on
/// the way. It shares only GridRay (the T of each plane) with the library. It walks in the grid's
/// own orientation, with integer voxel coordinates.
#include <algorithm>
#include <array>
#include <cstdint>
#include <unordered_set>
#include <vector>

#include "voxdag/trace/grid_ray.hpp"
#include "voxdag/trace/hit.hpp"

namespace voxdag {

/// A set with one bit per voxel, for small grids.
class DenseSet {
 public:
  DenseSet(int levels, const std::vector<Vec3i>& voxels)
      : levels_(levels), bits_(std::size_t{1} << (3 * levels)) {
    for (const Vec3i v : voxels) bits_[index(v)] = true;
  }
  int levels() const { return levels_; }
  bool contains(Vec3i v) const { return bits_[index(v)]; }

 private:
  std::size_t index(Vec3i v) const {
    return static_cast<std::size_t>((v.z << levels_ | v.y) << levels_ | v.x);
  }
  int levels_;
  std::vector<bool> bits_;
};

/// A hash set, for sparse voxels of large grids.
class SparseSet {
 public:
  SparseSet(int levels, const std::vector<Vec3i>& voxels) : levels_(levels) {
    for (const Vec3i v : voxels) keys_.insert(key(v));
  }
  int levels() const { return levels_; }
  bool contains(Vec3i v) const { return keys_.contains(key(v)); }

 private:
  static std::uint64_t key(Vec3i v) {
    return static_cast<std::uint64_t>(v.x) | static_cast<std::uint64_t>(v.y) << 20 |
           static_cast<std::uint64_t>(v.z) << 40;
  }
  int levels_;
  std::unordered_set<std::uint64_t> keys_;
};

/// Returns T at plane i (0..N) of an axis, in the order of the grid's own coordinates.
inline float reference_plane_t(const GridRay& ray, int levels, int axis, std::int32_t i) {
  const double plane = static_cast<double>(i) / static_cast<double>(1 << levels);
  const bool is_mirrored = (ray.mirrored >> axis & 1u) != 0;
  return ray.plane_t(axis, static_cast<float>(is_mirrored ? 2 - plane : 1 + plane));
}

/// Returns T at the plane of `axis` through which the ray enters the voxels with coordinate i.
inline float reference_enter(const GridRay& ray, int levels, int axis, std::int32_t i) {
  return reference_plane_t(ray, levels, axis, (ray.mirrored >> axis & 1u) != 0 ? i : i + 1);
}
inline float reference_leave(const GridRay& ray, int levels, int axis, std::int32_t i) {
  return reference_plane_t(ray, levels, axis, (ray.mirrored >> axis & 1u) != 0 ? i + 1 : i);
}

inline Hit reference_hit(const GridRay& ray, int levels, Vec3i voxel, float at, float t_min,
                         float t_max) {
  Hit hit;
  hit.hit = true;
  hit.voxel = voxel;
  hit.level = static_cast<std::int8_t>(levels);
  hit.t = std::clamp(static_cast<float>(ray.to_world_t(static_cast<double>(at))), t_min, t_max);
  for (int axis = 0; axis < 3 && hit.face == Face::kNone; ++axis) {
    if ((ray.parallel >> axis & 1u) != 0) continue;
    if (reference_enter(ray, levels, axis, voxel[axis]) != at) continue;
    const bool runs_up = (ray.mirrored >> axis & 1u) != 0;
    hit.face = static_cast<Face>(2 * axis + (runs_up ? 0 : 1));
  }
  return hit;
}

/// Casts a ray by 3D-DDA: starts in the voxel of t_min and steps over every plane that the next T
/// reaches.
template <class Set>
Hit reference_dda(const Set& set, const GridRay& ray, float t_min, float t_max) {
  if (ray.misses()) return {};
  const int levels = set.levels();
  const std::int32_t n = 1 << levels;
  float at = ray.t_min;
  Vec3i voxel, step;
  for (int axis = 0; axis < 3; ++axis) {
    // Bisects for the first voxel, in walking order, that the ray has not left at `at`.
    const bool runs_up = (ray.mirrored >> axis & 1u) != 0;
    std::int32_t passed = 0, above = n;
    while (passed < above) {
      const std::int32_t middle = (passed + above) / 2;
      if (reference_leave(ray, levels, axis, runs_up ? middle : n - 1 - middle) <= at)
        passed = middle + 1;
      else
        above = middle;
    }
    if (passed == n) return {};
    voxel[axis] = runs_up ? passed : n - 1 - passed;
    step[axis] = runs_up ? 1 : -1;
  }
  std::array<float, 3> leave;
  for (int axis = 0; axis < 3; ++axis)
    leave[axis] = reference_leave(ray, levels, axis, voxel[axis]);
  for (;;) {
    if (set.contains(voxel)) return reference_hit(ray, levels, voxel, at, t_min, t_max);
    at = std::min({leave[0], leave[1], leave[2]});
    if (at > ray.t_max) return {};
    for (int axis = 0; axis < 3; ++axis) {
      if (leave[axis] != at) continue;
      voxel[axis] += step[axis];
      if (voxel[axis] < 0 || voxel[axis] >= n) return {};
      leave[axis] = reference_leave(ray, levels, axis, voxel[axis]);
    }
  }
}

/// Applies the definition itself, without a walk: at t_min and at the T of every plane of the grid,
/// in order, counts on each axis the planes that the ray has passed. O(N²) per ray.
template <class Set>
Hit reference_by_definition(const Set& set, const GridRay& ray, float t_min, float t_max) {
  if (ray.misses()) return {};
  const int levels = set.levels();
  const std::int32_t n = 1 << levels;
  std::vector<float> events{ray.t_min};
  std::array<std::vector<float>, 3> planes;
  for (int axis = 0; axis < 3; ++axis) {
    for (std::int32_t i = 0; i <= n; ++i) {
      planes[axis].push_back(reference_plane_t(ray, levels, axis, i));
      if (planes[axis].back() > ray.t_min && planes[axis].back() <= ray.t_max)
        events.push_back(planes[axis].back());
    }
  }
  std::sort(events.begin(), events.end());
  for (const float at : events) {
    Vec3i voxel;
    bool is_inside = true;
    for (int axis = 0; axis < 3; ++axis) {
      const auto behind = static_cast<std::int32_t>(std::count_if(
          planes[axis].begin(), planes[axis].end(), [&](float t) { return t <= at; }));
      voxel[axis] = (ray.mirrored >> axis & 1u) != 0 ? behind - 1 : n - behind;
      is_inside = is_inside && voxel[axis] >= 0 && voxel[axis] < n;
    }
    if (!is_inside) return {};
    if (set.contains(voxel)) return reference_hit(ray, levels, voxel, at, t_min, t_max);
  }
  return {};
}

}  // namespace voxdag
