#pragma once
/// Distances from a point or a segment to cubes, in voxels.
#include <algorithm>

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

/// A little more than the distance from the centre of a cube of side 1 to its corners: more than
/// distances are rounded.
inline constexpr double kHalfDiagonal = 0.867;

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
  /// Returns the squared distance to the centre of a cube, which costs less than that to the cube.
  double centre_distance2(Vec3i first, std::int32_t side) const {
    const double half = 0.5 * side;
    const Vec3d to = static_cast<Vec3d>(first) + Vec3d{half, half, half} - from;
    const double u = is_point() ? 0 : std::clamp(dot(to, along) / dot(along, along), 0.0, 1.0);
    const Vec3d apart = to - along * u;
    return dot(apart, apart);
  }
  /// Returns the vector from the nearest point of the cube to the nearest point of the core.
  Vec3d apart(const Cube& cube) const { return cube.to(at(nearest(cube))); }
};

/// A box around a shape.
struct ShapeBox {
  Vec3d lo, hi;

  explicit ShapeBox(Vec3d point) : lo(point), hi(point) {}
  explicit ShapeBox(const ShapeCore& core)
      : lo(min(core.from, core.at(1))), hi(max(core.from, core.at(1))) {}

  /// Sets squares[i] to the squared distance to child i of a cube of 2 sides. Returns those of the
  /// children in the mask `cells` for which it is at most `most`. Each square is the sum of one of
  /// two terms of each axis, so that the compiler computes several at a time.
  std::uint32_t near(Vec3i first, std::int32_t side, double most, std::uint32_t cells,
                     double* squares) const {
    double terms[3][2];
    for (int axis = 0; axis < 3; ++axis) {
      const double begin = first[axis], middle = begin + side, end = middle + side;
      const double low = std::max(std::max(begin - hi[axis], 0.0), lo[axis] - middle),
                   high = std::max(std::max(middle - hi[axis], 0.0), lo[axis] - end);
      terms[axis][0] = low * low;
      terms[axis][1] = high * high;
    }
    std::uint32_t near = 0;
    for (int i = 0; i < 8; ++i)
      squares[i] = terms[0][i & 1] + terms[1][i >> 1 & 1] + terms[2][i >> 2];
    for (int i = 0; i < 8; ++i) near |= (squares[i] <= most ? 1u : 0u) << i;
    return near & cells;
  }
};

/// The cost of LeastCell for the cell that is nearest to a core: the squared distance.
struct SquaredDistance {
  ShapeCore core;
  ShapeBox box;

  explicit SquaredDistance(const ShapeCore& core_in) : core(core_in), box(core_in) {}

  std::uint32_t near(Vec3i first, std::int32_t side, double most, std::uint32_t cells,
                     double* bounds) const {
    return box.near(first, side, most, cells, bounds);
  }
  double bound(Vec3i first, std::int32_t side, double, double most) const {
    const double reach = std::sqrt(most) + kHalfDiagonal * side;
    if (core.centre_distance2(first, side) > reach * reach) return kNoCost;
    const Vec3d apart = core.apart({first, side});
    return dot(apart, apart);
  }
  double exact(Vec3i first, std::int32_t side, double bound_in, double most) const {
    return bound(first, side, bound_in, most);
  }
};

/// SquaredDistance of a point.
struct SquaredPointDistance {
  ShapeBox box;

  explicit SquaredPointDistance(Vec3d point) : box(point) {}

  std::uint32_t near(Vec3i first, std::int32_t side, double most, std::uint32_t cells,
                     double* bounds) const {
    return box.near(first, side, most, cells, bounds);
  }
  double bound(Vec3i, std::int32_t, double bound, double) const { return bound; }
  double exact(Vec3i, std::int32_t, double bound, double) const { return bound; }
};

}  // namespace voxdag
