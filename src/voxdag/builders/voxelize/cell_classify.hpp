#pragma once
/// Finds the children of an octree cell that a triangle meets, and the conditions that can still
/// fail in them.
///
/// The functions of triangle_setup.hpp take their least and greatest values over a cell at two of
/// its corner voxels, so the result is exact for a cell of any size. If the plane's sums over a
/// cell need more than 64 bits, the plane is tested only in smaller cells.
#include <bit>
#include <cstdint>

#include "voxdag/builders/voxelize/triangle_setup.hpp"

namespace voxdag {

/// The result for the children (x=1, y=2, z=4) of a cell. Bit i of `alive` is set if the triangle
/// meets child i. conditions(i) are the conditions that some voxels of child i may fail. Dominant
/// edges stay until the child's whole column is inside the triangle; then only the plane can fail.
struct ChildConditions {
  std::uint32_t alive = 0xFF;
  std::uint64_t lanes[2];  ///< Eight 16-bit sets.

  std::uint32_t conditions(int child) const {
    return static_cast<std::uint32_t>(lanes[child >> 2] >> (16 * (child & 3))) & 0xFFFFu;
  }
};

namespace detail {

inline constexpr std::uint32_t kLowChildren[3] = {0x55, 0x33, 0x0F};
inline constexpr std::uint64_t kEveryLane = 0x0001000100010001ull;

/// The children in the columns of some of the four quadrants (u=1, v=2) of projection p, as a mask
/// and as 16-bit lanes.
struct QuadrantChildren {
  std::uint32_t mask[3][16];
  std::uint64_t lanes[3][16][2];
};

constexpr QuadrantChildren make_quadrant_children() {
  QuadrantChildren table{};
  for (int p = 0; p < 3; ++p)
    for (int set = 0; set < 16; ++set)
      for (int child = 0; child < 8; ++child) {
        const int quadrant = ((child >> kProjectionU[p]) & 1) | ((child >> kProjectionV[p]) & 1)
                                                                    << 1;
        if (((set >> quadrant) & 1) == 0) continue;
        table.mask[p][set] |= 1u << child;
        table.lanes[p][set][child >> 2] |= std::uint64_t{0xFFFF} << (16 * (child & 3));
      }
  return table;
}

inline constexpr QuadrantChildren kQuadrantChildren = make_quadrant_children();

}  // namespace detail

/// Classifies the children of a cell of (2*half)³ voxels. `cell` is its lowest voxel, relative to
/// the setup's origin; `conditions` are the conditions that its voxels may fail.
VOXDAG_FORCE_INLINE ChildConditions classify_children(const TriangleSetup& t,
                                                      std::uint32_t conditions, Vec3i cell,
                                                      std::int32_t half) {
  using namespace detail;
  ChildConditions result;
  if (conditions & kBox) {
    bool inside = true;
    for (int axis = 0; axis < 3; ++axis) {
      const std::int32_t middle = cell[axis] + half;
      if (t.box_lo[axis] >= middle) result.alive &= ~kLowChildren[axis];
      if (t.box_hi[axis] < middle) result.alive &= kLowChildren[axis];
      inside &= t.box_lo[axis] <= cell[axis] && t.box_hi[axis] >= middle + half - 1;
    }
    if (inside) conditions &= ~kBox;
  }
  result.lanes[0] = result.lanes[1] = conditions * kEveryLane;

  if ((conditions & kPlane) && slab_range(t, cell, 2 * half) == 1) {
    const Vec3l& n = t.plane.normal;
    const std::int64_t last = half - 1, lo = slab_lo_at(t, cell);
    const std::int64_t least = lo - last * (positive(n.x) + positive(n.y) + positive(n.z));
    const std::int64_t most =
        lo + t.plane.width - last * (negative(n.x) + negative(n.y) + negative(n.z));
    const std::int64_t x = n.x * half, y = n.y * half, z = n.z * half;
    const std::int64_t value[8] = {0, x, y, x + y, z, x + z, y + z, x + y + z};
    std::uint32_t meets = 0;
    for (int child = 0; child < 8; ++child)
      meets |= static_cast<std::uint32_t>(value[child] >= least && value[child] <= most) << child;
    result.alive &= meets;
  }

  for (std::uint32_t left = conditions & kAllEdges; left != 0 && result.alive != 0;
       left &= left - 1) {
    const int edge = std::countr_zero(left);
    const int projection = edge / 3;
    const std::int64_t a = t.a[edge], b = t.b[edge];
    const std::int64_t value =
        t.c[edge] + a * cell[kProjectionU[projection]] + b * cell[kProjectionV[projection]];
    const std::int64_t last = half - 1;
    const std::int64_t some = -last * (positive(a) + positive(b));
    const bool dominant = (t.dominant_edges >> edge) & 1;
    const std::int64_t all =
        -last * (negative(a) + negative(b)) + (dominant ? absolute(a) + absolute(b) : 0);
    const std::int64_t values[4] = {value, value + a * half, value + b * half,
                                    value + (a + b) * half};
    std::uint32_t meets = 0, inside = 0;
    for (int quadrant = 0; quadrant < 4; ++quadrant) {
      meets |= static_cast<std::uint32_t>(values[quadrant] >= some) << quadrant;
      inside |= static_cast<std::uint32_t>(values[quadrant] >= all) << quadrant;
    }
    result.alive &= kQuadrantChildren.mask[projection][meets];
    const std::uint64_t bit = kEveryLane << edge;
    result.lanes[0] &= ~(kQuadrantChildren.lanes[projection][inside][0] & bit);
    result.lanes[1] &= ~(kQuadrantChildren.lanes[projection][inside][1] & bit);
  }
  return result;
}

}  // namespace voxdag
