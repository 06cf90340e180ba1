#pragma once
/// Polygons with more than three corners, cut into triangles.
#include <span>

#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// Makes the fan of one polygon cover that polygon. `fan` holds {c0, c1, c2}, {c0, c2, c3}, ... for
/// the corners c; every index is in range of `vertices`.
///
/// A fan that covers the polygon stays: that of a convex one always does. The fan of any other
/// polygon gives way to as many triangles cut off as ears, as seen along the polygon's normal.
/// A polygon that crosses itself or has no area gets triangles over its corners all the same, and
/// one with a corner that is not finite keeps its fan. The result depends on the corners alone.
/// Time: n log n for n corners but for contrived shapes; memory while it runs: about 50 bytes per
/// corner of a polygon whose fan does not stay.
void cut_polygon(std::span<Triangle> fan, std::span<const Vec3f> vertices);

}  // namespace voxdag
