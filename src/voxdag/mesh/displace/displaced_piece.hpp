#pragma once
/// Pieces of a displaced triangle: a volume that encloses a piece for every tessellation, and the
/// split at the midpoints of long edges. Only the length of an edge decides, so both of its
/// triangles split it equally.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "voxdag/core/box.hpp"
#include "voxdag/core/interval.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {

/// Contains the points of a flat triangle, moved along the interpolated normals of its corners by
/// heights between two bounds, and moved by up to `slack` in any direction.
struct DisplacedPiece {
  std::array<Vec3d, 3> corners;    ///< Flat triangle, world units.
  std::array<double, 3> reach{};   ///< Bound on how far each corner moves.
  std::array<Vec3f, 3> normals{};  ///< Unit length, or zero.
  float shortest = 1;              ///< No mean of the normals is shorter than this.
  Interval heights{0, 0};
  double slack = 0;

  /// Returns the least and greatest dot(direction, p) of all points p in the volume.
  Interval along(Vec3d direction) const {
    std::array<double, 3> at;
    std::array<float, 3> component;
    for (std::size_t i = 0; i < 3; ++i) {
      at[i] = dot(direction, corners[i]);
      component[i] = dot(static_cast<Vec3f>(direction), normals[i]);
    }
    return interval_along(at, component, std::sqrt(dot(direction, direction)));
  }

  Box3d box() const {
    const auto along_axis = [&](int axis) {
      return interval_along({corners[0][axis], corners[1][axis], corners[2][axis]},
                            {normals[0][axis], normals[1][axis], normals[2][axis]}, 1);
    };
    const Interval x = along_axis(0), y = along_axis(1), z = along_axis(2);
    return {{x.lo, y.lo, z.lo}, {x.hi, y.hi, z.hi}};
  }

  /// Returns the area vector of the flat triangle: half of the cross product of two edges.
  Vec3d area() const { return cross(corners[1] - corners[0], corners[2] - corners[0]) * 0.5; }

 private:
  /// Returns along() for a direction of this length. `at` and `component` are the components of
  /// corners and normals along it.
  Interval interval_along(const std::array<double, 3>& at, const std::array<float, 3>& component,
                          double length) const {
    const auto [least, most] = std::minmax({component[0], component[1], component[2]});
    const Interval normal{least < 0 ? least / shortest : least, most > 0 ? most / shortest : most};
    const Interval offset = normal * heights;
    Interval all{std::min({at[0], at[1], at[2]}) + offset.lo - slack * length,
                 std::max({at[0], at[1], at[2]}) + offset.hi + slack * length};
    for (std::size_t i = 0; i < 3; ++i) {
      const double far = reach[i] * length;
      all = {std::min(all.lo, at[i] - far), std::max(all.hi, at[i] + far)};
    }
    return all;
  }
};

/// A corner of a piece of a triangle.
struct PieceCorner {
  Vec3d position;  ///< Before displacement, world units.
  Vec3f normal;    ///< Interpolated, not normalised.
  /// Barycentric coordinates: the weights of corners 1 and 2 of the triangle. Exact, because they
  /// result from halving.
  float b1 = 0, b2 = 0;
  /// Bit mask of the triangle's edges that the corner lies on; two bits at the triangle's corners.
  std::uint8_t edges = 0;
  bool is_displaced = false;  ///< Whether `displaced` is known.
  Vec3d displaced;            ///< The position after displacement.
};

inline PieceCorner middle(const PieceCorner& a, const PieceCorner& b) {
  return {(a.position + b.position) * 0.5,
          (a.normal + b.normal) * 0.5f,
          (a.b1 + b.b1) * 0.5f,
          (a.b2 + b.b2) * 0.5f,
          static_cast<std::uint8_t>(a.edges & b.edges),
          false,
          {}};
}

inline double distance2(const PieceCorner& a, const PieceCorner& b) {
  const Vec3d d = a.position - b.position;
  return dot(d, d);
}

/// Returns whether no edge is longer than `limit` world units.
inline bool is_small(const PieceCorner& a, const PieceCorner& b, const PieceCorner& c,
                     double limit) {
  const double limit2 = limit * limit;
  return distance2(a, b) <= limit2 && distance2(b, c) <= limit2 && distance2(c, a) <= limit2;
}

namespace detail {

/// Splits a piece whose only long edge is ab.
template <class Body>
void split_one_edge(PieceCorner& a, PieceCorner& b, PieceCorner& c, const Body& body) {
  PieceCorner d = middle(a, b);
  body(a, d, c);
  body(d, b, c);
}

/// Splits a piece whose edges bc and ca are long; ab is not.
template <class Body>
void split_two_edges(PieceCorner& a, PieceCorner& b, PieceCorner& c, const Body& body) {
  PieceCorner e = middle(b, c), f = middle(c, a);
  body(f, e, c);
  if (distance2(a, e) <= distance2(b, f)) {
    body(a, b, e);
    body(a, e, f);
  } else {
    body(a, b, f);
    body(b, e, f);
  }
}

template <class Body>
void split_three_edges(PieceCorner& a, PieceCorner& b, PieceCorner& c, const Body& body) {
  PieceCorner d = middle(a, b), e = middle(b, c), f = middle(c, a);
  body(a, d, f);
  body(d, b, e);
  body(f, e, c);
  body(d, e, f);
}

}  // namespace detail

/// Calls body(a, b, c) for the two to four parts of a piece that is not small.
template <class Body>
void for_each_part(PieceCorner& a, PieceCorner& b, PieceCorner& c, double limit, const Body& body) {
  const double limit2 = limit * limit;
  const bool ab = distance2(a, b) > limit2, bc = distance2(b, c) > limit2,
             ca = distance2(c, a) > limit2;
  const int count = ab + bc + ca;
  if (count == 3) {
    detail::split_three_edges(a, b, c, body);
  } else if (count == 2) {
    if (!ab)
      detail::split_two_edges(a, b, c, body);
    else if (!bc)
      detail::split_two_edges(b, c, a, body);
    else
      detail::split_two_edges(c, a, b, body);
  } else {
    if (ab)
      detail::split_one_edge(a, b, c, body);
    else if (bc)
      detail::split_one_edge(b, c, a, body);
    else
      detail::split_one_edge(c, a, b, body);
  }
}

}  // namespace voxdag
