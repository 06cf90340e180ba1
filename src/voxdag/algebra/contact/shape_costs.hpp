#pragma once
/// The costs by which LeastCell finds the voxel that a shape touches, or touches first.
#include <algorithm>
#include <cmath>

#include "voxdag/algebra/contact/contacts.hpp"
#include "voxdag/algebra/contact/core_distance.hpp"

namespace voxdag {

/// 0 for cells that a capsule touches.
struct CapsuleTouch {
  ShapeCore core;
  double radius;
  ShapeBox box;

  CapsuleTouch(const ShapeCore& core_in, double radius_in)
      : core(core_in), radius(radius_in), box(core_in) {}

  double reach2() const { return (radius + kTouch) * (radius + kTouch); }
  std::uint32_t near(Vec3i first, std::int32_t side, double, std::uint32_t cells,
                     double* bounds) const {
    return box.near(first, side, reach2(), cells, bounds);
  }
  double bound(Vec3i first, std::int32_t side, double bound, double) const {
    if (core.is_point()) return bound;
    const double square2 = core.centre_distance2(first, side),
                 outer = radius + kTouch + kHalfDiagonal * side;
    if (square2 <= radius * radius) return bound;
    if (square2 > outer * outer) return kNoCost;
    const Vec3d apart = core.apart({first, side});
    const double square = dot(apart, apart);
    return square <= reach2() ? square : kNoCost;
  }
  double exact(Vec3i first, std::int32_t side, double bound_in, double most) const {
    return bound(first, side, bound_in, most) == kNoCost ? kNoCost : 0;
  }
  /// Returns whether the ball around a cube is in the capsule.
  bool covers(Vec3i first, std::int32_t side) const {
    const double rest = radius - kHalfDiagonal * side;
    return rest >= 0 && core.centre_distance2(first, side) <= rest * rest;
  }
};

/// The squared distance from a core to cells that the capsule touches, and approaches.
struct ApproachedDistance : SquaredDistance {
  double reach2;
  Vec3d motion;

  ApproachedDistance(const ShapeCore& core_in, double radius, Vec3d motion_in)
      : SquaredDistance(core_in),
        reach2((radius + kTouch) * (radius + kTouch)),
        motion(motion_in) {}

  std::uint32_t near(Vec3i first, std::int32_t side, double most, std::uint32_t cells,
                     double* bounds) const {
    return box.near(first, side, std::min(most, reach2), cells, bounds);
  }
  double bound(Vec3i first, std::int32_t side, double bound_in, double most) const {
    const double square = SquaredDistance::bound(first, side, bound_in, std::min(most, reach2));
    return square <= reach2 ? square : kNoCost;
  }
  double exact(Vec3i first, std::int32_t side, double bound_in, double most) const {
    const Vec3d apart = core.apart({first, side});
    const bool is_left = dot(apart, apart) > 0 && dot(apart, motion) >= 0;
    return is_left ? kNoCost : bound(first, side, bound_in, most);
  }
};

/// 0 for cells that a box touches: those that none of 15 directions separates.
///
/// Source: S. Gottschalk, M. C. Lin, D. Manocha, "OBBTree: A Hierarchical Structure for Rapid
/// Interference Detection", 1996, section 5.
class BoxTouch {
 public:
  explicit BoxTouch(const OrientedBox& box) : box_(box), centre_(box.centre) {
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        reach2_ += box.half[a] * box.half[b] * std::fabs(dot(box.axes[a], box.axes[b]));
    reach2_ = reach2_ * (1 + 1e-9) + 1;
    for (const Vec3d& side : box.axes) add(side);
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d unit{};
      unit[axis] = 1;
      add(unit);
      for (const Vec3d& side : box.axes) add(cross(unit, side));
    }
  }

  std::uint32_t near(Vec3i first, std::int32_t side, double, std::uint32_t cells,
                     double* bounds) const {
    return centre_.near(first, side, reach2_, cells, bounds);
  }
  double bound(Vec3i first, std::int32_t side, double bound, double) const {
    const double half = 0.5 * side;
    const Vec3d apart = box_.centre - static_cast<Vec3d>(first) - Vec3d{half, half, half};
    for (int i = 0; i < count_; ++i)
      if (std::fabs(dot(apart, directions_[i].along)) >
          half * directions_[i].cube + directions_[i].box)
        return kNoCost;
    return bound;
  }
  double exact(Vec3i first, std::int32_t side, double bound_in, double most) const {
    return bound(first, side, bound_in, most) == kNoCost ? kNoCost : 0;
  }
  bool covers(Vec3i first, std::int32_t side) const {
    const double half = 0.5 * side;
    // Axes may be a little longer, shorter and oblique (box_in()).
    const double slack = 1e-5 * (box_.half.x + box_.half.y + box_.half.z);
    const Vec3d apart = box_.centre - static_cast<Vec3d>(first) - Vec3d{half, half, half};
    for (int i = 0; i < 3; ++i)
      if (!(std::fabs(dot(apart, directions_[i].along)) + half * directions_[i].cube <=
            box_.half[i] - slack))
        return false;
    return true;
  }

 private:
  struct Direction {
    Vec3d along;
    double cube;  ///< How far a cube of side 2 reaches along it.
    double box;   ///< How far the box does, and kTouch.
  };

  void add(Vec3d along) {
    const double size = length(along);
    if (size < 1e-12) return;  // Two sides are parallel.
    along = along * (1 / size);
    double reach = kTouch;
    for (int axis = 0; axis < 3; ++axis)
      reach += box_.half[axis] * std::fabs(dot(box_.axes[axis], along));
    directions_[count_++] = {along, std::fabs(along.x) + std::fabs(along.y) + std::fabs(along.z),
                             reach};
  }

  OrientedBox box_;
  ShapeBox centre_;
  double reach2_ = 0;  ///< The squared distance from the centre to a corner, or a little more.
  Direction directions_[15];
  int count_ = 0;
};

/// The part of a motion after which a capsule touches a cell.
///
/// The distance between two convex bodies is a convex function of the time if they do not turn. So
/// Newton's method that starts before the contact goes to it from one side, and never beyond.
class TouchTime {
 public:
  TouchTime(const ShapeCore& core, double radius, Vec3d motion)
      : core_(core), radius_(radius), motion_(motion) {
    const Vec3d end = core.at(1), reach = Vec3d{1, 1, 1} * (radius + kTouch);
    lo_ = min(core.from, end) - reach;
    hi_ = max(core.from, end) + reach;
  }

  /// The bounds are the times at which the box around the capsule touches the cells.
  std::uint32_t near(Vec3i first, std::int32_t side, double most, std::uint32_t cells,
                     double* bounds) const {
    double begin[3][2], end[3][2];
    for (int axis = 0; axis < 3; ++axis)
      for (int i = 0; i < 2; ++i) {
        const double lo = first[axis] + i * side, step = motion_[axis];
        const double before = lo - hi_[axis], after = lo + side - lo_[axis];
        const bool is_apart = before > 0 || after < 0;
        begin[axis][i] = step == 0 ? is_apart ? kNoCost : 0 : (step > 0 ? before : after) / step;
        end[axis][i] = step == 0 ? kNoCost : (step > 0 ? after : before) / step;
      }
    std::uint32_t near = 0;
    for (int i = 0; i < 8; ++i) {
      const int x = i & 1, y = i >> 1 & 1, z = i >> 2;
      bounds[i] = std::max(std::max(begin[0][x], begin[1][y]), std::max(begin[2][z], 0.0));
      const double until = std::min(std::min(end[0][x], end[1][y]), std::min(end[2][z], most));
      near |= (bounds[i] <= until && bounds[i] < kNoCost ? 1u : 0u) << i;
    }
    return near & cells;
  }
  double bound(Vec3i first, std::int32_t side, double bound, double most) const {
    return time({first, side}, bound, most, false, nullptr);
  }
  double exact(Vec3i first, std::int32_t side, double bound, double most) const {
    return time({first, side}, bound, most, true, nullptr);
  }
  /// Returns the direction from a voxel to the core when they touch, of unit length; 0 if they are
  /// closer than 1e-6 voxels at the start.
  Vec3d normal(Vec3i voxel) const {
    Vec3d apart{};
    time({voxel, 1}, 0, kNoCost, true, &apart);
    return normalized_or(apart, {});
  }

  ShapeCore core_at(double t) const { return {core_.from + motion_ * t, core_.along}; }

 private:
  /// Returns when the capsule touches a cube, at `t` or later, kNoCost if later than `most` or
  /// never. `must_near`: and if it approaches it then. Sets `apart` to the vector between them at
  /// the last time at which its direction was certain.
  double time(const Cube& cube, double t, double most, bool must_near, Vec3d* apart) const {
    while (t <= most) {
      const Vec3d between = core_at(t).apart(cube);
      const double square = dot(between, between), slope = dot(between, motion_);
      if (apart != nullptr && square > 1e-12) *apart = between;
      const double distance = std::sqrt(square);
      if (distance <= radius_ + kTouch) return must_near && square > 0 && slope >= 0 ? kNoCost : t;
      if (slope >= 0) return kNoCost;
      const double next = t - (distance - radius_ - kTouch / 2) * distance / slope;
      if (!(next > t)) return t;
      t = next;
    }
    return kNoCost;
  }

  ShapeCore core_;
  double radius_;
  Vec3d motion_, lo_, hi_;
};

}  // namespace voxdag
