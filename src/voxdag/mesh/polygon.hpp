#pragma once
/// Polygons with more than three corners, cut into triangles.
#include <functional>
#include <span>

#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// Makes the fan of one polygon cover that polygon. `fan` holds {c0, c1, c2}, {c0, c2, c3}, ... for
/// the corners c; every index is in range of `vertices`.
///
/// A fan that covers the polygon already stays, as that of every convex polygon does. Any other fan
/// is replaced by as many triangles, cut off as ears in a projection along the polygon's normal. A
/// polygon that crosses itself or has no area gets triangles over its corners nevertheless. One
/// with a corner that is not finite keeps its fan. The result depends on the corners alone.
///
/// Time: n log n for n corners. `poll`, if not empty, is called at least every 0.1 s and may throw
/// to stop the work. Throws Error, without a place, for contrived polygons that would cost more.
/// Memory while it runs: about 70 bytes per corner of a polygon whose fan does not stay.
void cut_polygon(std::span<Triangle> fan, std::span<const Vec3f> vertices,
                 const std::function<void()>& poll = {});

}  // namespace voxdag
