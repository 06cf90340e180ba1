#pragma once
/// Distances from a point or a segment to cubes, in voxels.
#include "voxdag/algebra/contact/least_cell.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {

/// The closed cube of the voxels from `first` on.
struct Cube {
  Vec3d lo, hi;

  Cube(Vec3i first, std::int32_t side) : lo(first), hi(lo + Vec3d{1, 1, 1} * double(side)) {}
  /// Returns the vector to a point from the nearest point of the cube; 0 in it.
  Vec3d to(Vec3d p) const { return p - min(max(p, lo), hi); }
};

/// The middle of a ball or a capsule: the points from + u along, 0 <= u <= 1.
struct ShapeCore {
  Vec3d from, along;

  bool is_point() const { return along == Vec3d{}; }
  Vec3d at(double u) const { return from + along * u; }

  /// Returns the least u whose point is nearest to the cube.
  double nearest(const Cube& cube) const {
    if (is_point()) return 0;
    // Half the derivative of the squared distance: it grows with u, and is linear between the
    // planes of the cube's faces.
    const auto slope = [&](double u) { return dot(cube.to(at(u)), along); };
    double low = 0, high = 1, at_low = slope(0), at_high = slope(1);
    if (at_low >= 0) return 0;
    if (at_high <= 0) return 1;
    for (int axis = 0; axis < 3; ++axis)
      for (const double plane : {cube.lo[axis], cube.hi[axis]}) {
        const double u = (plane - from[axis]) / along[axis];
        if (!(u > low && u < high)) continue;
        const double here = slope(u);
        (here < 0 ? low : high) = u;
        (here < 0 ? at_low : at_high) = here;
      }
    return low + (high - low) * (at_low / (at_low - at_high));
  }
  /// Returns the vector from the nearest point of the cube to the nearest point of the core.
  Vec3d apart(const Cube& cube) const { return cube.to(at(nearest(cube))); }
};

/// The cost of LeastCell for the cell that is nearest to a core: the squared distance.
struct SquaredDistance {
  ShapeCore core;

  double bound(Vec3i first, std::int32_t side, double) const {
    const Vec3d apart = core.apart({first, side});
    return dot(apart, apart);
  }
  double exact(Vec3i first, std::int32_t side, double most) const {
    return bound(first, side, most);
  }
};

/// SquaredDistance of a point.
struct SquaredPointDistance {
  Vec3d point;

  double bound(Vec3i first, std::int32_t side, double) const {
    const Vec3d apart = Cube(first, side).to(point);
    return dot(apart, apart);
  }
  double exact(Vec3i first, std::int32_t side, double most) const {
    return bound(first, side, most);
  }
};

}  // namespace voxdag
