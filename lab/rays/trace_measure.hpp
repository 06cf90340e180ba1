#pragma once
/// Measures rays per second.
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "lab/rays/trace_rays.hpp"
#include "lab/rays/trace_runner.hpp"

namespace voxdag::lab {

/// The time that a runner took for a set, and its hits.
struct Measured {
  double seconds = HUGE_VAL;
  std::vector<std::uint8_t> hits;
};

/// Casts the `count` rays of a set on all threads. The runners take turns, so that other load on
/// the machine affects all of them. The first turn warms up; then the fastest of `repeat` turns
/// counts.
std::vector<Measured> measure(const std::vector<TraceRunner>& runners, std::size_t count,
                              int repeat);

/// Returns the number of rays for which both or neither hit something.
std::size_t agreeing(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b);

/// Returns the number of rays whose closest hits, of two runners with closest_t, are a hundredth of
/// a voxel apart at most, or for which neither hits something.
std::size_t hits_at_same_place(const Grid& grid, std::span<const CastRay> rays,
                               const TraceRunner& a, const TraceRunner& b);

/// Returns a sample of the rays, in runs of 64 that are spread evenly over the set: all of them if
/// there are fewer than 2 * most, else about `most` to 1.5 * most.
std::vector<CastRay> sample_of(std::span<const CastRay> rays, std::size_t most);

}  // namespace voxdag::lab
