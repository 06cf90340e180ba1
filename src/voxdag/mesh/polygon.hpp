#pragma once
/// Cuts polygons with more than three corners into triangles.
#include <functional>
#include <span>

#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// Makes the fan of one polygon cover that polygon. `fan` holds {c0, c1, c2}, {c0, c2, c3}, ... for
/// the corners c; every index is in range of `vertices`.
///
/// If the fan covers the polygon, it stays unchanged; every convex polygon keeps its fan. Any other
/// fan is replaced by the same number of triangles, cut off as ears in a projection along the
/// polygon's normal. A polygon that crosses itself or has no area also gets triangles over its
/// corners. A polygon with a corner that is not finite keeps its fan. The result depends on the
/// corners alone.
///
/// Time: n log n for n corners. `poll`, if not empty, is called at least every 0.1 s and may throw
/// to stop the work. Throws Error, without a place, for contrived polygons that would cost more.
/// Scratch memory: about 70 bytes per corner, if the fan is replaced.
void cut_polygon(std::span<Triangle> fan, std::span<const Vec3f> vertices,
                 const std::function<void()>& poll = {});

}  // namespace voxdag
