#pragma once
/// An interval of numbers, with arithmetic for bounds.
#include <algorithm>
#include <cmath>

namespace voxdag {

struct Interval {
  double lo = HUGE_VAL, hi = -HUGE_VAL;  ///< Empty unless lo <= hi.

  void add(double v) {
    lo = v < lo ? v : lo;
    hi = v > hi ? v : hi;
  }
  double size() const { return hi - lo; }

  friend Interval operator*(Interval a, Interval b) {
    const auto [least, most] = std::minmax({a.lo * b.lo, a.lo * b.hi, a.hi * b.lo, a.hi * b.hi});
    return {least, most};
  }
};

}  // namespace voxdag
