#include <algorithm>
#include <cmath>

#include "voxdag/formats/scenes/courtyard_parts.hpp"

/// The tiled roof and the bell gable above it.
namespace voxdag::scenes::courtyard {

void tiled_roof(Builder& b, const Detail& d, Random& random, double width, double run,
                double rise) {
  b.material("tile");
  const double slope = std::sqrt(run * run + rise * rise), pitch = 0.24, course = 0.4;
  const Vec3d up = Vec3d{0, rise, -run} * (1 / slope), out = Vec3d{0, run, rise} * (1 / slope);
  const int columns = static_cast<int>((width + 2 * run) / pitch + 0.5);
  const int sides = d(8, 4);
  for (int c = 0; c < columns; ++c) {
    const double x = -run + (c + 0.5) * (width + 2 * run) / columns;
    const double valley = std::max({0.0, -x, x - width}) / run * slope;
    const int first = static_cast<int>(std::ceil(valley / course - 0.6)),
              last = static_cast<int>(slope / course);
    for (int k = first; k <= last; ++k) {
      const double lo = k * course - 0.03, hi = std::min((k + 1) * course + 0.03, slope);
      if (lo > slope - 0.2) continue;
      const double jitter = random.uniform(-0.008, 0.008), lift = random.uniform(0, 0.006);
      // The cover tile tapers uphill and overlaps the next one's foot; a pan tile lies beside it.
      for (int pan = 0; pan < 2; ++pan) {
        const double shift = pan == 1 ? pitch / 2 : 0;
        const double r0 = pan == 1 ? 0.09 : 0.085, r1 = r0 - 0.012, thick = 0.014;
        const auto point = [&](double s, double radius, double t, double raise) {
          const double across = radius * cos_turns(t), above = radius * sin_turns(t);
          return Vec3d{x + shift + jitter + across, 0, 0} + up * s +
                 out * (pan == 1 ? raise - above + 0.06 : raise + above);
        };
        const double raise = 0.03 + lift;
        // Outer skin, lower edge, inner skin.
        b.surface(sides, 3, false, false, [&](int i, int j) {
          const double t = 0.5 - 0.5 * i / sides;
          if (j == 0) return point(lo + 0.12, r0 - thick, t, raise + 0.01);
          if (j == 1) return point(lo, r0 - thick, t, raise + 0.02);
          if (j == 2) return point(lo, r0, t, raise + 0.02);
          return point(hi, r1, t, raise);
        });
      }
    }
  }
  // The boards underneath.
  b.material("wood");
  const double drop = -0.05;
  const auto board = [&](double x, double s) { return Vec3d{x, drop, 0} + up * s; };
  b.quad(board(0, 0), board(width, 0), board(width + run, slope), board(-run, slope));
  b.quad(board(width, -0.02) - out * 0.05, board(0, -0.02) - out * 0.05,
         board(-run, slope) - out * 0.05, board(width + run, slope) - out * 0.05);
  b.quad(board(0, -0.02) - out * 0.05, board(width, -0.02) - out * 0.05, board(width, 0),
         board(0, 0));
  const int rafters = static_cast<int>(width / 0.5);
  for (int i = 0; i <= rafters; ++i) {
    const double x = width * i / rafters;
    b.at({board(x, 0) - out * 0.05, {1, 0, 0}, out, up * -1.0}, [&] {
      b.box({-0.05, -0.12, -1.2}, {0.05, 0, -0.04});
    });
  }
}

void bell_gable(Builder& b, const Detail& d) {
  const double bay = 1.7, half = 1.5 * bay + 0.25, thickness = 0.6, spring = 2.3, top = 3.5;
  b.material("plaster");
  b.box({-half, -0.6, -thickness / 2}, {half, 1.1, thickness / 2});
  for (int i = 0; i < 4; ++i) {
    const double x = (i - 1.5) * bay;
    b.box({x - 0.25, 1.1, -thickness / 2}, {x + 0.25, spring, thickness / 2});
  }
  for (int i = 0; i < 3; ++i)
    b.at({{(i - 1.5) * bay, spring, 0}},
         [&] { arch_wall(b, d, bay, top - spring, bay / 2 - 0.25, thickness); });
  for (const double s : {-1.0, 1.0})
    b.box({std::min(s * 1.5 * bay, s * half), spring, -thickness / 2},
          {std::max(s * 1.5 * bay, s * half), top, thickness / 2});
  b.material("marble");
  for (int i = 0; i < 3; ++i)
    for (const double face : {0.0, 0.5})
      b.at(placed({(i - 1) * bay, spring, face == 0 ? thickness / 2 : -thickness / 2}, face),
           [&] { archivolt(b, d, bay / 2 - 0.25, 0.16); });
  for (int i = 0; i < 4; ++i) {
    const double x = (i - 1.5) * bay;
    b.box({x - 0.3, spring - 0.16, -thickness / 2 - 0.06}, {x + 0.3, spring, thickness / 2 + 0.06});
    b.box({x - 0.3, 1.1, -thickness / 2 - 0.05}, {x + 0.3, 1.25, thickness / 2 + 0.05});
  }
  b.moulding({{0, 0.95}, {0.08, 0.98}, {0.1, 1.08}, {0.02, 1.12}, {0, 1.12}}, half, thickness / 2,
             true);
  b.at({{0, top, 0}}, [&] {
    b.moulding({{0, 0}, {0.06, 0.04}, {0.08, 0.14}, {0.22, 0.2}, {0.24, 0.32}, {-0.3, 0.34}}, half,
               thickness / 2, true);
    // The pediment: raking mouldings over a recessed triangle.
    const double rise = 1.25, w = half + 0.24, z = thickness / 2;
    b.quad({-w, 0.3, z}, {w, 0.3, z}, {0, 0.3 + rise, z}, {0, 0.3 + rise, z});
    b.quad({w, 0.3, -z}, {-w, 0.3, -z}, {0, 0.3 + rise, -z}, {0, 0.3 + rise, -z});
    const double slope = std::sqrt(w * w + rise * rise);
    for (const double s : {-1.0, 1.0}) {
      const Vec3d along{w / slope, s * -rise / slope, 0}, up{s * rise / slope, w / slope, 0};
      b.at({{s < 0 ? -w : 0, s < 0 ? 0.3 : 0.3 + rise, 0}, along, up, {0, 0, 1}}, [&] {
        b.box({-0.02, -0.06, -z - 0.14}, {slope + 0.02, 0.08, z + 0.14});
        b.box({-0.04, 0.08, -z - 0.24}, {slope + 0.04, 0.2, z + 0.24});
      });
    }
    b.at({{0, 0.75, z}}, [&] { rosette(b, d, 0.3); });
    b.at({{0, 0.3 + rise + 0.12, 0}}, [&] {
      b.square({{0.22, 0}, {0.22, 0.25}, {0.26, 0.28}, {0.26, 0.34}, {0, 0.34}});
      b.lathe(rounded({{0.08, 0.34},
                       {0.06, 0.42},
                       {0.2, 0.6},
                       {0.18, 0.78},
                       {0.05, 0.92},
                       {0.03, 1.1},
                       {0, 1.2}},
                      d(5, 2)),
              d(24, 8));
    });
    for (const double s : {-1.0, 1.0})
      b.at({{s * (w - 0.2), 0.42, 0}}, [&] {
        b.square({{0.2, -0.1}, {0.2, 0.2}, {0.24, 0.24}, {0.24, 0.3}, {0, 0.3}});
        b.at({{0, 0.3, 0}}, [&] { amphora(b, d, 0.7); });
      });
  });
  b.material("bronze");
  for (int i = 0; i < 3; ++i)
    b.at({{(i - 1) * bay, spring + 0.42, 0}}, [&] {
      b.tube({{-0.75, 0, 0}, {0.75, 0, 0}}, 0.05, d(10, 6));
      b.lathe(rounded({{0.28, -0.7},
                       {0.36, -0.72},
                       {0.34, -0.64},
                       {0.26, -0.45},
                       {0.21, -0.22},
                       {0.19, -0.12},
                       {0.1, -0.06},
                       {0.06, 0}},
                      d(4, 2)),
              d(36, 8));
      b.tube({{0, -0.2, 0}, {0, -0.6, 0.02}, {0, -0.82, 0.03}}, {0.02, 0.03, 0.06}, d(8, 5));
    });
}

}  // namespace voxdag::scenes::courtyard
