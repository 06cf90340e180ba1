#pragma once
/// The angle of a vector in the plane, with the same bits on every machine.
#include <algorithm>
#include <cmath>
#include <numbers>

namespace voxdag {

/// Returns the angle of (x, y) from the x-axis, -pi to pi, as std::atan2 does, to 1e-15. The
/// standard one may round in other ways on other processors. Returns 0 for (0, 0), and pi on the
/// negative x-axis.
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

}  // namespace voxdag
