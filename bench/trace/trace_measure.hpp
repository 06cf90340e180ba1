#pragma once
/// How `voxdag bench` measures rays per second.
#include <cmath>
#include <cstdint>
#include <vector>

#include "bench/rivals/trace_rivals.hpp"

namespace voxdag {

/// What a runner took for a set, and found.
struct Measured {
  double seconds = HUGE_VAL;
  std::vector<std::uint8_t> hits;
};

/// Casts the `count` rays of a set on all threads. All runners take turns, so that what disturbs
/// the machine disturbs all of them; the first turn warms up, the fastest of `repeat` others
/// counts.
std::vector<Measured> measure(const std::vector<TraceRunner>& runners, std::size_t count,
                              int repeat);

/// For how many rays both or neither met something.
std::size_t agreeing(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b);

}  // namespace voxdag
