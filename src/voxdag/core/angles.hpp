#pragma once
/// Angles, with the same bits on every machine. Those of the C library differ in the last bit
/// between processors: glibc fuses products and sums where the processor can.
#include <algorithm>
#include <cmath>
#include <numbers>

namespace voxdag {

/// Returns the angle of (x, y) from the x-axis, -pi to pi, as std::atan2 does, to 1e-15. Returns 0
/// for (0, 0), and pi on the negative x-axis.
inline double arc_tangent(double y, double x) {
  // The arc tangents of 0/8 to 8/8.
  constexpr double kTable[9] = {
      0.0,
      0.12435499454676143503,
      0.24497866312686415417,
      0.35877067027057222040,
      0.46364760900080611621,
      0.55859931534356243597,
      0.64350110879328438680,
      0.71882999962162450542,
      0.78539816339744830962,
  };
  const double long_side = std::max(std::abs(x), std::abs(y)),
               short_side = std::min(std::abs(x), std::abs(y));
  if (!(long_side > 0)) return 0;
  const double ratio = short_side / long_side;
  const int step = static_cast<int>(ratio * 8 + 0.5);
  const double from = step / 8.0;
  // tan(a - b) = (tan a - tan b) / (1 + tan a tan b), at most 1/16.
  const double t = (ratio - from) / (1 + ratio * from), t2 = t * t;
  const double series =
      1 + t2 * (-1.0 / 3 + t2 * (1.0 / 5 + t2 * (-1.0 / 7 + t2 * (1.0 / 9 + t2 * (-1.0 / 11)))));
  double angle = kTable[step] + t * series;
  if (std::abs(y) > std::abs(x)) angle = std::numbers::pi / 2 - angle;
  if (x < 0) angle = std::numbers::pi - angle;
  return y < 0 ? -angle : angle;
}

/// Returns the angle whose cosine is `cosine`, which is -1 to 1: 0 to pi, to 1e-15.
inline double arc_cosine(double cosine) {
  return arc_tangent(std::sqrt((1 - cosine) * (1 + cosine)), cosine);
}

struct SineCosine {
  double sine = 0, cosine = 1;
};

/// Returns the sine and the cosine of an angle in radians, to 3e-16 if it is at most 1000.
inline SineCosine sine_and_cosine(double angle) {
  if (std::abs(angle) > 1000) angle = std::fmod(angle, 2 * std::numbers::pi);
  // The angle beyond the nearest quarter turn, by Taylor's series. Two numbers add up to pi / 2.
  constexpr double kQuarter = std::numbers::pi / 2, kQuarterRest = 6.123233995736766036e-17;
  const double quarters = std::round(angle / kQuarter);
  const double x = std::fma(-quarters, kQuarterRest, std::fma(-quarters, kQuarter, angle));
  const double x2 = x * x;
  double sine = 1, cosine = 1;
  for (int n = 18; n > 0; n -= 2) {
    cosine = 1 - cosine * (x2 / (n * (n - 1)));
    sine = 1 - sine * (x2 / (n * (n + 1)));
  }
  sine *= x;
  switch (static_cast<int>(std::fmod(quarters, 4)) & 3) {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

inline double cosine_of(double angle) { return sine_and_cosine(angle).cosine; }

}  // namespace voxdag
