#pragma once
/// Mathematics for scenes. It uses exactly rounded operations only, so that meshes are equal on
/// every machine. Angles are in turns: 1 is the full circle.
#include <cmath>
#include <initializer_list>
#include <numbers>

#include "voxdag/core/vec.hpp"

namespace voxdag::scenes {

/// Returns the sine of 2 pi t, by the Taylor polynomial on a quarter turn. The absolute error is
/// below 1e-15.
inline double sin_turns(double t) {
  t -= std::floor(t + 0.5);
  if (t > 0.25) t = 0.5 - t;
  if (t < -0.25) t = -0.5 - t;
  const double x = 2 * std::numbers::pi * t, s = x * x;
  double sum = -1.0 / 121645100408832000.0;  // -1/19!
  for (const double c :
       {1.0 / 355687428096000.0, -1.0 / 1307674368000.0, 1.0 / 6227020800.0, -1.0 / 39916800.0,
        1.0 / 362880.0, -1.0 / 5040.0, 1.0 / 120.0, -1.0 / 6.0, 1.0})
    sum = sum * s + c;
  return sum * x;
}
inline double cos_turns(double t) { return sin_turns(t + 0.25); }

inline double lerp(double a, double b, double t) { return a + (b - a) * t; }
inline Vec3d lerp(Vec3d a, Vec3d b, double t) { return a + (b - a) * t; }
inline double clamp01(double v) { return v < 0 ? 0 : v > 1 ? 1 : v; }
/// Returns 0 below a, 1 above b, and a smooth curve in between.
inline double smoothstep(double a, double b, double v) {
  const double t = clamp01((v - a) / (b - a));
  return t * t * (3 - 2 * t);
}

/// Returns a unit vector perpendicular to the unit vector v.
inline Vec3d perpendicular(Vec3d v) {
  const Vec3d axis = v.x * v.x < 0.5 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  return normalized(cross(v, axis));
}

/// Maps local coordinates to the world: axes are orthogonal, right-handed and of equal length.
struct Frame {
  Vec3d origin{};
  Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

  Vec3d point(Vec3d p) const { return origin + direction(p); }
  Vec3d direction(Vec3d d) const { return x * d.x + y * d.y + z * d.z; }
  /// Returns the frame `f`, given in local coordinates, in the world.
  Frame operator*(const Frame& f) const {
    return {point(f.origin), direction(f.x), direction(f.y), direction(f.z)};
  }
};

/// Returns a frame at `origin`, turned about y (from z towards x) and scaled uniformly.
inline Frame placed(Vec3d origin, double turns = 0, double scale = 1) {
  const double c = cos_turns(turns) * scale, s = sin_turns(turns) * scale;
  return {origin, {c, 0, -s}, {0, scale, 0}, {s, 0, c}};
}

}  // namespace voxdag::scenes
