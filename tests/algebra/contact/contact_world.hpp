#pragma once
/// Random shapes and voxels in a grid, and their distances by other formulas than the library's.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "support/brute_svdag.hpp"
#include "voxdag/algebra/contact/contacts.hpp"

namespace voxdag {
inline constexpr double kNever = HUGE_VAL;

/// Returns the point of the cube of a voxel that is nearest to a point. Units are voxels.
inline Vec3d nearest_in(Vec3i voxel, Vec3d p) {
  for (int axis = 0; axis < 3; ++axis)
    p[axis] = std::clamp(p[axis], double(voxel[axis]), double(voxel[axis]) + 1);
  return p;
}
inline double point_gap(Vec3i voxel, Vec3d p) { return length(p - nearest_in(voxel, p)); }

/// Returns the distance from a segment to the cube of a voxel: the least of the distances at its
/// ends and at the least points of all 27 sums of squares that the squared distance consists of.
inline double segment_gap(Vec3i voxel, Vec3d from, Vec3d to) {
  const Vec3d along = to - from;
  double least = std::min(point_gap(voxel, from), point_gap(voxel, to));
  for (int pattern = 0; pattern < 27; ++pattern) {
    double squares = 0, products = 0;
    for (int axis = 0, rest = pattern; axis < 3; ++axis, rest /= 3) {
      if (rest % 3 == 0) continue;
      const double plane = voxel[axis] + rest % 3 - 1;
      squares += along[axis] * along[axis];
      products += along[axis] * (plane - from[axis]);
    }
    if (squares > 0)
      least =
          std::min(least, point_gap(voxel, from + along * std::clamp(products / squares, 0., 1.)));
  }
  return least;
}

inline double gap(Vec3i voxel, const Capsule& shape) {
  return segment_gap(voxel, shape.from, shape.to) - shape.radius;
}

inline Capsule moved(const Capsule& shape, Vec3d motion) {
  return {shape.from + motion, shape.to + motion, shape.radius};
}

/// Returns the part of a motion after which a capsule touches a voxel that it approaches, kNever if
/// it does not: by bisection, because the gap falls to its least value and then grows. NaN if
/// rounding decides.
inline double touch_time(Vec3i voxel, const Capsule& shape, Vec3d motion) {
  const auto gap_at = [&](double t) { return gap(voxel, moved(shape, motion * t)); };
  if (gap_at(0) > length(motion)) return kNever;
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    const bool is_left = gap_at(a) <= gap_at(b);
    (is_left ? high : low) = is_left ? b : a;
  }
  const double least = gap_at(high);
  if (std::fabs(least) < 1e-6) return std::nan("");
  if (least > 0) return kNever;
  if (gap_at(0) <= 0) {
    if (segment_gap(voxel, shape.from, shape.to) == 0) return 0;
    return high < 1e-6 ? kNever : 0;
  }
  low = 0;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (gap_at(middle) > 0 ? low : high) = middle;
  }
  return low;
}

/// Random shapes in and around a grid of 2^levels, in voxels.
class Shapes {
 public:
  Shapes(int levels, unsigned seed) : side_(1 << levels), random_(seed) {}

  double number(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vec3d point() {
    const double reach = 0.3 * side_;
    return {number(-reach, side_ + reach), number(-reach, side_ + reach),
            number(-reach, side_ + reach)};
  }
  Vec3d vector(double most) {
    return {number(-most, most), number(-most, most), number(-most, most)};
  }
  /// Returns points, spheres, segments and capsules.
  Capsule capsule() {
    const Vec3d from = point();
    const int kind = static_cast<int>(random_() % 4);
    return {from, (kind & 1) != 0 ? from + vector(0.4 * side_) : from,
            (kind & 2) != 0 ? number(0, 0.2 * side_) : 0};
  }

 private:
  int side_;
  std::mt19937 random_;
};

/// A grid whose voxels are not of size 1. `world` are functions from voxels to world units.
struct World {
  Svdag dag;
  ContactScene scene;

  World(int levels, const std::vector<Vec3i>& voxels) : dag(brute_svdag(levels, voxels)) {
    scene.dag = dag.view();
    scene.grid.levels = levels;
    scene.grid.origin = {-3, 0.5, 20};
    scene.grid.voxel_size = 0.25;  // Exact, so that voxels stay what they are.
  }
  Vec3d place(Vec3d voxels) const { return scene.grid.to_world(voxels); }
  double size(double voxels) const { return voxels * scene.grid.voxel_size; }
  Capsule shape(const Capsule& voxels) const {
    return {place(voxels.from), place(voxels.to), size(voxels.radius)};
  }
};

inline constexpr double kClose = 1e-9;  ///< Rounding of coordinates and of two formulas.

}  // namespace voxdag
