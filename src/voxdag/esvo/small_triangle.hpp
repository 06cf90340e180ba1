#pragma once
/// classify_children() for triangles that are small next to their cell's: three edges at a time.
#include <algorithm>
#include <cstdlib>

#include "voxdag/esvo/lanes.hpp"
#include "voxdag/voxelize/cell_classify.hpp"

namespace voxdag {

/// Whether floats hold all that the edges' functions are within a cell of 2^log2_size voxels at the
/// setup's origin.
inline bool has_small_edges(const TriangleSetup& t, int log2_size) {
  std::int64_t steepest = 0, farthest = 0;
  for (int edge = 0; edge < 9; ++edge) {
    steepest = std::max(steepest, detail::absolute(t.a[edge]) + detail::absolute(t.b[edge]));
    farthest = std::max(farthest, detail::absolute(t.c[edge]));
  }
  constexpr std::int64_t kMost = std::int64_t{1} << 24;
  return farthest < kMost && steepest < kMost && farthest + (steepest << log2_size) < kMost;
}

/// What classify_children() finds, for cells within one for which has_small_edges() holds; but
/// children that are voxels keep all of `conditions`.
inline ChildConditions classify_small_children(const TriangleSetup& t, std::uint32_t conditions,
                                               Vec3i cell, std::int32_t half) {
  using namespace detail;
  ChildConditions result = classify_by_box_and_plane(t, conditions, cell, half);
  if (result.alive == 0) return result;
  const auto side = static_cast<float>(half), last = side - 1;
  const auto three = [](const auto* from) {
    return FloatLanes{static_cast<float>(from[0]), static_cast<float>(from[1]),
                      static_cast<float>(from[2]), 0};
  };
  const FloatLanes zero{};
  for (int projection = 0; projection < 3; ++projection) {
    const int first = 3 * projection;
    const std::uint32_t open = conditions >> first & 7u;
    if (open == 0) continue;
    const FloatLanes a = three(t.a + first), b = three(t.b + first);
    const FloatLanes value = three(t.c + first) +
                             a * static_cast<float>(cell[kProjectionU[projection]]) +
                             b * static_cast<float>(cell[kProjectionV[projection]]);
    const FloatLanes above = max(a, zero) + max(b, zero), below = min(a, zero) + min(b, zero);
    const bool is_dominant = (t.dominant_edges >> first & 1u) != 0;
    const FloatLanes some = above * -last;
    const FloatLanes all = is_dominant ? above - below * side : below * -last;
    const FloatLanes next_u = value + a * side;
    const FloatLanes values[4] = {value, next_u, value + b * side, next_u + b * side};
    std::uint32_t meets = 0;
    for (std::uint32_t quadrant = 0; quadrant < 4; ++quadrant) {
      const std::uint32_t met = lane_bits(values[quadrant] >= some) | ~open;
      meets |= ((met & 7u) == 7u ? 1u : 0u) << quadrant;
      if (half == 1) continue;
      const std::uint64_t inside = lane_bits(values[quadrant] >= all) & open;
      const std::uint64_t closed = (inside << first) * kEveryLane;
      const auto& lanes = kQuadrantChildren.lanes[projection][1u << quadrant];
      result.lanes[0] &= ~(closed & lanes[0]);
      result.lanes[1] &= ~(closed & lanes[1]);
    }
    result.alive &= kQuadrantChildren.mask[projection][meets];
  }
  return result;
}

}  // namespace voxdag
