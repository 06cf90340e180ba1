#pragma once
/// The reference for casts at an ESVO. It tests every leaf with its cube and the contours of all
/// its ancestors, in double precision, on the tree that the ESVO was made from.
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "support/test_esvo.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/trace/grid_ray.hpp"

namespace voxdag {

/// A ray as grid_ray.hpp defines it, in the grid's own [0,1]³: origin + T * direction.
struct ReferenceRay {
  Vec3d origin, direction;
  double t_min, t_max;

  explicit ReferenceRay(const GridRay& ray)
      : t_min(static_cast<double>(ray.t_min)), t_max(static_cast<double>(ray.t_max)) {
    for (int axis = 0; axis < 3; ++axis) {
      const bool is_mirrored = (ray.mirrored >> axis & 1u) != 0;
      const double o = static_cast<double>(ray.origin[axis]);
      const double d = 1 / static_cast<double>(ray.inverse[axis]);
      origin[axis] = is_mirrored ? 2 - o : o - 1;
      direction[axis] = (ray.parallel >> axis & 1u) != 0 ? 0 : is_mirrored ? d : -d;
    }
  }
  Vec3d at(double t) const { return origin + direction * t; }
};

/// The distance by which the half-spaces of a shape are moved inwards (outwards if negative), in
/// units of the grid's side.
struct Inset {
  double cube = 0, contour = 0;
};

struct ReferenceHit {
  double t;
  int level;
  Vec3i cell;  ///< In cells of `level`.
};

class ReferenceCast {
 public:
  ReferenceCast(const ReferenceRay& ray, Inset inset) : ray_(ray), inset_(inset) {}

  /// Returns the nearest leaf, or voxel of `last_level` if that is coarser.
  std::optional<ReferenceHit> nearest(const TestVoxel& root, int last_level) {
    last_level_ = last_level;
    visit(root, 0, {}, {ray_.t_min, ray_.t_max});
    return best_;
  }

 private:
  struct Range {
    double enter, leave;
    bool is_empty() const { return !(enter <= leave); }
    /// Clips the range to the t with a - t * b <= 0.
    void clip(double a, double b) {
      if (b == 0) {
        if (a > 0) leave = -HUGE_VAL;
      } else if (b > 0) {
        enter = std::max(enter, a / b);
      } else {
        leave = std::min(leave, a / b);
      }
    }
  };

  void visit(const TestVoxel& voxel, int level, Vec3i cell, Range range) {
    const double side = std::ldexp(1.0, -level);
    const Vec3d lo = static_cast<Vec3d>(cell) * side;
    Range cube = range;
    for (int axis = 0; axis < 3; ++axis) {
      const double o = ray_.origin[axis], d = ray_.direction[axis];
      cube.clip(lo[axis] + inset_.cube - o, d);
      cube.clip(o - (lo[axis] + side - inset_.cube), -d);
    }
    if (voxel.contour) {
      const Vec3d n = static_cast<Vec3d>(voxel.contour->normal());
      const double half = side / 2, length = std::sqrt(dot(n, n));
      const std::int32_t n1 = length1(voxel.contour->normal());
      const Vec3d centre = lo + Vec3d{half, half, half};
      const double o = dot(n, ray_.origin - centre), d = dot(n, ray_.direction);
      const double high = half * contour_position<double>(n1, voxel.contour->high());
      const double low = half * contour_position<double>(n1, voxel.contour->low());
      for (Range* r : {&range, &cube}) {
        r->clip(low + inset_.contour * length - o, d);
        r->clip(o - (high - inset_.contour * length), -d);
      }
    }
    // Descendants also lie in this cube, but their insets must not be added to its inset.
    if (cube.is_empty()) return;
    if (voxel.is_leaf() || level == last_level_) {
      if (!best_ || cube.enter < best_->t) best_ = {cube.enter, level, cell};
      return;
    }
    for (int i = 0; i < 8; ++i)
      if (const TestVoxel* child = voxel.children[static_cast<std::size_t>(i)].get())
        visit(*child, level + 1, cell * 2 + child_offset(i), range);
  }

  ReferenceRay ray_;
  Inset inset_;
  int last_level_ = 0;
  std::optional<ReferenceHit> best_;
};

/// Returns whether a point lies in the shape of the voxel `cell` of `level`, within `slack`.
inline bool is_in_shape(const TestVoxel& root, int level, Vec3i cell, Vec3d point, double slack) {
  const TestVoxel* voxel = &root;
  for (int l = 0; l <= level; ++l) {
    const double side = std::ldexp(1.0, -l);
    const Vec3i at{cell.x >> (level - l), cell.y >> (level - l), cell.z >> (level - l)};
    if (l > 0)
      voxel =
          voxel->children[static_cast<std::size_t>((at.x & 1) | (at.y & 1) << 1 | (at.z & 1) << 2)]
              .get();
    if (voxel == nullptr) return false;
    const Vec3d lo = static_cast<Vec3d>(at) * side;
    for (int axis = 0; axis < 3; ++axis)
      if (point[axis] < lo[axis] - slack || point[axis] > lo[axis] + side + slack) return false;
    if (!voxel->contour) continue;
    const Vec3d n = static_cast<Vec3d>(voxel->contour->normal());
    const Vec3d centre = lo + Vec3d{side / 2, side / 2, side / 2};
    const double at_n = dot(n, point - centre), room = slack * std::sqrt(dot(n, n));
    const std::int32_t n1 = length1(voxel->contour->normal());
    if (at_n < side / 2 * contour_position<double>(n1, voxel->contour->low()) - room) return false;
    if (at_n > side / 2 * contour_position<double>(n1, voxel->contour->high()) + room) return false;
  }
  return true;
}

}  // namespace voxdag
