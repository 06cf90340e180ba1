#include <algorithm>
#include <cmath>

#include "voxdag/formats/scenes/city_parts.hpp"

namespace voxdag::scenes::city {
namespace {

void water_tank(Builder& b) {
  b.material("wood");
  for (const double x : {-1.0, 1.0})
    for (const double z : {-1.0, 1.0}) b.box({x - 0.1, 0, z - 0.1}, {x + 0.1, 2.6, z + 0.1});
  b.lathe({{0, 2.5}, {1.7, 2.5}, {1.7, 5.3}, {1.85, 5.3}, {1.85, 5.4}, {0.1, 6.6}, {0, 6.6}}, 20);
  b.material("metal");
  for (const double y : {3.0, 3.9, 4.8}) b.at({{0, y, 0}}, [&] { b.torus(1.71, 0.035, 20, 4); });
}

void cooler(Builder& b, Random& random) {
  b.material("metal");
  const double w = random.uniform(0.7, 1.5), h = random.uniform(0.9, 1.7);
  b.box({-w, 0, -0.8}, {w, h, 0.8});
  for (int i = 0; i < 7; ++i)
    b.box({-w + 0.1, 0.15 + i * (h - 0.3) / 7, 0.8}, {w - 0.1, 0.22 + i * (h - 0.3) / 7, 0.86});
  for (const double x : {-w / 2, w / 2})
    b.at({{x, h, 0}}, [&] {
      const double r = w * 0.4;
      b.lathe({{r, 0}, {r, 0.2}, {r - 0.05, 0.2}, {r - 0.05, 0.05}, {0, 0.05}}, 14);
      b.box({-r + 0.04, 0.12, -0.03}, {r - 0.04, 0.16, 0.03});
      b.box({-0.03, 0.12, -r + 0.04}, {0.03, 0.16, r - 0.04});
    });
}

void solar_panels(Builder& b) {
  b.material("glass");
  for (int i = 0; i < 4; ++i)
    b.at({{0, 0.6, i * 1.3 - 2},
          {1, 0, 0},
          {0, cos_turns(0.07), sin_turns(0.07)},
          {0, -sin_turns(0.07), cos_turns(0.07)}},
         [&] {
           b.box({-2.2, -0.03, -0.5}, {2.2, 0.03, 0.5});
         });
}

void antenna(Builder& b, Random& random) {
  b.material("metal");
  const double h = random.uniform(4, 9);
  b.tube({{0, 0, 0}, {0, h * 0.6, 0}, {0, h, 0}}, {0.1, 0.06, 0.03}, 6);
  for (int i = 0; i < 5; ++i) {
    const double y = h * (0.5 + 0.09 * i), w = 0.9 - 0.12 * i;
    b.box({-w, y - 0.02, -0.02}, {w, y + 0.02, 0.02});
  }
}

}  // namespace

void flat_roof(Builder& b, const Footprint& footprint, double y) {
  b.material("roof");
  std::vector<Vec3d> corners;
  for (const Point2 p : footprint) corners.push_back({p.x, y, p.y});
  b.fan(corners);
  b.material("trim");
  band(b, footprint, y,
       {{0, -0.02},
        {0.02, 0.75},
        {0.08, 0.78},
        {0.08, 0.92},
        {-0.36, 0.92},
        {-0.36, 0.78},
        {-0.3, 0.75},
        {-0.3, 0}});
}

void roof_clutter(Builder& b, Random& random, double x0, double x1, double z0, double z1,
                  double y) {
  const double w = x1 - x0, d = z1 - z0;
  if (w < 8 || d < 8) return;
  const int things = 2 + random.below(static_cast<int>(w * d / 120) + 2);
  const int nx = std::max(1, static_cast<int>((w - 2) / 6)),
            nz = std::max(1, static_cast<int>((d - 2) / 6));
  std::vector<int> spots(static_cast<std::size_t>(nx) * nz);
  for (std::size_t i = 0; i < spots.size(); ++i) spots[i] = static_cast<int>(i);
  for (std::size_t i = spots.size(); i > 1; --i)
    std::swap(spots[i - 1], spots[random.below(static_cast<int>(i))]);
  for (int i = 0; i < things && i < static_cast<int>(spots.size()); ++i) {
    const int spot = spots[i];
    const int column = spot % nx, row = spot / nx;
    const double x = x0 + 1 + (column + 0.5) * (w - 2) / nx,
                 z = z0 + 1 + (row + 0.5) * (d - 2) / nz;
    b.at(placed({x, y, z}, 0.25 * random.below(4)), [&] {
      const double kind = random.uniform();
      if (i == 0) {
        b.material("concrete");
        b.box({-1.6, 0, -2.2}, {1.6, 2.8, 2.2});
        b.box({-1.8, 2.8, -2.4}, {1.8, 3.0, 2.4});
        b.material("wood");
        b.box({-0.5, 0, 2.2}, {0.5, 2.1, 2.26});
      } else if (kind < 0.16) {
        water_tank(b);
      } else if (kind < 0.62) {
        cooler(b, random);
      } else if (kind < 0.8) {
        solar_panels(b);
      } else {
        antenna(b, random);
      }
    });
  }
}

void pitched_roof(Builder& b, Random& random, double x0, double x1, double z0, double z1,
                  double y) {
  const double rise = (z1 - z0) * random.uniform(0.32, 0.5), over = 0.5, zc = (z0 + z1) / 2;
  const double slope = rise / ((z1 - z0) / 2);
  b.material("tile");
  const int courses = static_cast<int>((z1 - z0) / 2 / 0.45) + 1;
  // Each course is a step, like tiles that overlap.
  for (const double s : {-1.0, 1.0}) {
    const double edge = (z1 - z0) / 2 + over;
    Profile outline;  // distance from the ridge and height, from the eaves up
    for (int i = courses; i >= 0; --i) {
      const double out = edge * i / courses;
      if (i < courses) outline.push_back({out, y + rise - slope * out + 0.07});
      outline.push_back({out, y + rise - slope * out});
    }
    Profile foot = {{edge, y + rise - slope * edge - 0.2}};
    outline.insert(outline.begin(), foot.begin(), foot.end());
    const int last = static_cast<int>(outline.size()) - 1;
    const double from = s > 0 ? x0 - over : x1 + over, to = s > 0 ? x1 + over : x0 - over;
    b.surface(1, last, false, false, [&](int i, int j) {
      const Point2 p = outline[j];
      return Vec3d{i == 0 ? from : to, p.y, zc + s * p.x};
    });
  }
  b.material("stucco");
  const auto gable = [&](double x, double s) {
    const Vec3d a{x, y, zc + s * (z1 - zc)}, c{x, y, zc - s * (z1 - zc)}, top{x, y + rise, zc};
    b.fan({a, c, top});
  };
  gable(x1, 1);
  gable(x0, -1);
  const int dormers = static_cast<int>((x1 - x0) / 5);
  for (const double s : {-1.0, 1.0})
    for (int i = 0; i < dormers; ++i)
      b.at(placed({lerp(x0, x1, (i + 0.5) / dormers), y + rise * 0.25, zc + s * (z1 - z0) * 0.38},
                  s > 0 ? 0 : 0.5),
           [&] {
             b.material("stucco");
             b.box({-0.7, -0.4, -2.5}, {0.7, 1.3, 0.3});
             b.material("glass");
             b.box({-0.45, 0.2, 0.3}, {0.45, 1.15, 0.33});
             b.material("tile");
             b.quad({-0.9, 1.25, 0.5}, {0, 2.0, 0.5}, {0, 2.0, -2.6}, {-0.9, 1.25, -2.6});
             b.quad({0, 2.0, 0.5}, {0.9, 1.25, 0.5}, {0.9, 1.25, -2.6}, {0, 2.0, -2.6});
             b.fan({{-0.7, 1.3, 0.3}, {0.7, 1.3, 0.3}, {0, 1.88, 0.3}});
           });
  b.material("brick");
  const double cx = random.uniform(x0 + 1, x1 - 1), top = y + rise + 1.4;
  b.box({cx - 0.45, y + rise * 0.4, zc + 0.5}, {cx + 0.45, top, zc + 1.3});
  b.box({cx - 0.55, top, zc + 0.4}, {cx + 0.55, top + 0.2, zc + 1.4});
  for (const double x : {-0.2, 0.2})
    b.at({{cx + x, top + 0.2, zc + 0.9}}, [&] {
      b.lathe({{0.15, 0}, {0.12, 0.45}, {0, 0.45}}, 10);
    });
}

}  // namespace voxdag::scenes::city
