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

  double bound(Vec3i first, std::int32_t side, double) const {
    const Vec3d apart = core.apart({first, side});
    const double reach = radius + kTouch;
    return dot(apart, apart) <= reach * reach ? 0 : kNoCost;
  }
  double exact(Vec3i first, std::int32_t side, double most) const {
    return bound(first, side, most);
  }
};

/// The squared distance from a core to cells that the capsule touches, and approaches.
struct ApproachedDistance {
  ShapeCore core;
  double radius;
  Vec3d motion;

  double bound(Vec3i first, std::int32_t side, double) const {
    const Vec3d apart = core.apart({first, side});
    const double reach = radius + kTouch, square = dot(apart, apart);
    return square <= reach * reach ? square : kNoCost;
  }
  double exact(Vec3i first, std::int32_t side, double most) const {
    const Vec3d apart = core.apart({first, side});
    const bool is_left = dot(apart, apart) > 0 && dot(apart, motion) >= 0;
    return is_left ? kNoCost : bound(first, side, most);
  }
};

/// 0 for cells that a box touches: those that none of 15 directions separates.
///
/// Source: S. Gottschalk, M. C. Lin, D. Manocha, "OBBTree: A Hierarchical Structure for Rapid
/// Interference Detection", 1996, section 5.
class BoxTouch {
 public:
  explicit BoxTouch(const OrientedBox& box) : box_(box) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d unit{};
      unit[axis] = 1;
      add(unit);
      add(box.axes[axis]);
      for (const Vec3d& side : box.axes) add(cross(unit, side));
    }
  }

  double bound(Vec3i first, std::int32_t side, double) const {
    const double half = 0.5 * side;
    const Vec3d apart = box_.centre - static_cast<Vec3d>(first) - Vec3d{half, half, half};
    for (int i = 0; i < count_; ++i)
      if (std::fabs(dot(apart, directions_[i].along)) >
          half * directions_[i].cube + directions_[i].box)
        return kNoCost;
    return 0;
  }
  double exact(Vec3i first, std::int32_t side, double most) const {
    return bound(first, side, most);
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

  double bound(Vec3i first, std::int32_t side, double most) const {
    return time({first, side}, most, false, nullptr);
  }
  double exact(Vec3i first, std::int32_t side, double most) const {
    return time({first, side}, most, true, nullptr);
  }
  /// Returns the direction from a voxel to the core when they touch, of unit length; 0 if they are
  /// closer than 1e-6 voxels at the start.
  Vec3d normal(Vec3i voxel) const {
    Vec3d apart{};
    time({voxel, 1}, kNoCost, true, &apart);
    return normalized_or(apart, {});
  }

  ShapeCore core_at(double t) const { return {core_.from + motion_ * t, core_.along}; }

 private:
  /// Returns when the box around the capsule touches the cube.
  double box_time(const Cube& cube, double most) const {
    double begin = 0, end = most;
    for (int axis = 0; axis < 3; ++axis) {
      const double before = cube.lo[axis] - hi_[axis], after = cube.hi[axis] - lo_[axis];
      const double step = motion_[axis];
      if (step == 0) {
        if (before > 0 || after < 0) return kNoCost;
        continue;
      }
      begin = std::max(begin, (step > 0 ? before : after) / step);
      end = std::min(end, (step > 0 ? after : before) / step);
    }
    return begin <= end ? begin : kNoCost;
  }

  /// Returns when the capsule touches a cube, kNoCost if later than `most` or never. `must_near`:
  /// and if it approaches it then. Sets `apart` to the vector between them at the last time at
  /// which its direction was certain.
  double time(const Cube& cube, double most, bool must_near, Vec3d* apart) const {
    double t = apart == nullptr ? box_time(cube, most) : 0;
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
