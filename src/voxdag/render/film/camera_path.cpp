/// Sources: Yuksel, Schaefer and Keyser, "Parameterization and Applications of Catmull-Rom Curves",
/// Computer-Aided Design 43(7), 2011, for the curves; Fritsch and Carlson, "Monotone Piecewise
/// Cubic Interpolation", SIAM J. Numer. Anal. 17(2), 1980, with the weights of Fritsch and Butland
/// for the slopes.
#include "voxdag/render/film/camera_path.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

/// Returns the cubic on [0,width] with values a, b and slopes da, db at its ends, at `x`.
template <class T>
T hermite(T a, T b, T da, T db, double width, double x) {
  const double s = x / width, s2 = s * s, s3 = s2 * s;
  return a * (2 * s3 - 3 * s2 + 1) + b * (3 * s2 - 2 * s3) +
         (da * (s3 - 2 * s2 + s) + db * (s3 - s2)) * width;
}

/// Returns the monotone cubic through values(i) at keys[i].time: it does not overshoot.
template <class Values>
double monotone_cubic(const std::vector<CameraKey>& keys, std::size_t i, double time,
                      const Values& values) {
  const auto width = [&](std::size_t k) { return keys[k + 1].time - keys[k].time; };
  const auto secant = [&](std::size_t k) { return (values(k + 1) - values(k)) / width(k); };
  const auto slope = [&](std::size_t k) {
    if (k == 0) return secant(0);
    if (k + 1 == keys.size()) return secant(k - 1);
    const double before = secant(k - 1), after = secant(k);
    if (!(before * after > 0)) return 0.0;
    const double w0 = 2 * width(k) + width(k - 1), w1 = width(k) + 2 * width(k - 1);
    return (w0 + w1) / (w0 / before + w1 / after);
  };
  return hermite(values(i), values(i + 1), slope(i), slope(i + 1), width(i), time - keys[i].time);
}

/// Returns a point on the curve through point(i). `time` lies between keys i and i + 1.
template <class Point>
Vec3d along_curve(const std::vector<CameraKey>& keys, std::size_t i, double time,
                  const Point& point) {
  // The distance between knots is the square root of the distance between points. It is never 0, so
  // that a camera may rest.
  const auto gap = [&](std::size_t k) {
    const Vec3d d = point(k + 1) - point(k);
    return std::max(std::pow(dot(d, d), 0.25), 1e-9);
  };
  std::vector<double> knots(keys.size());
  for (std::size_t k = 0; k + 1 < keys.size(); ++k) knots[k + 1] = knots[k] + gap(k);
  const auto velocity = [&](std::size_t k) {  // per knot
    const bool has_before = k > 0, has_after = k + 1 < keys.size();
    const auto secant = [&](std::size_t j) { return (point(j + 1) - point(j)) * (1 / gap(j)); };
    if (!has_before) return secant(k);
    if (!has_after) return secant(k - 1);
    const double before = gap(k - 1), after = gap(k);
    const Vec3d wide = (point(k + 1) - point(k - 1)) * (1 / (before + after));
    return secant(k - 1) - wide + secant(k);
  };
  const double knot = monotone_cubic(keys, i, time, [&](std::size_t k) { return knots[k]; });
  return hermite(point(i), point(i + 1), velocity(i), velocity(i + 1), gap(i), knot - knots[i]);
}

void check(const std::vector<CameraKey>& keys) {
  if (keys.empty()) throw Error("a camera path needs at least one key");
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto refuse = [&](const char* reason) {
      throw Error("", "key " + std::to_string(i), reason);
    };
    const View& view = keys[i].view;
    const auto is_finite = [](Vec3d v) { return std::isfinite(v.x + v.y + v.z); };
    if (!std::isfinite(keys[i].time)) refuse("its time is not a finite number");
    if (i > 0 && !(keys[i].time > keys[i - 1].time))
      refuse("its time is not greater than the time of the key before");
    if (!is_finite(view.eye) || !is_finite(view.target) || !is_finite(view.up))
      refuse("its eye, target or up is not finite");
    if (view.eye == view.target) refuse("its eye and target are the same point");
    if (!(view.vertical_fov_degrees > 0 && view.vertical_fov_degrees < 180))
      refuse("its fov must be above 0 and below 180 degrees");
  }
}

}  // namespace

CameraPath::CameraPath(std::vector<CameraKey> keys) : keys_(std::move(keys)) { check(keys_); }

View CameraPath::at(double time) const {
  if (!(time > start())) return keys_.front().view;
  if (!(time < end())) return keys_.back().view;
  const auto after = std::upper_bound(keys_.begin(), keys_.end(), time,
                                      [](double t, const CameraKey& key) { return t < key.time; });
  const auto i = static_cast<std::size_t>(after - keys_.begin()) - 1;
  View view;
  view.eye = along_curve(keys_, i, time, [&](std::size_t k) { return keys_[k].view.eye; });
  view.target = along_curve(keys_, i, time, [&](std::size_t k) { return keys_[k].view.target; });
  for (int axis = 0; axis < 3; ++axis)
    view.up[axis] =
        monotone_cubic(keys_, i, time, [&](std::size_t k) { return keys_[k].view.up[axis]; });
  view.vertical_fov_degrees = monotone_cubic(
      keys_, i, time, [&](std::size_t k) { return keys_[k].view.vertical_fov_degrees; });
  return view;
}

}  // namespace voxdag
