#include <cmath>

#include "voxdag/formats/scenes/courtyard_parts.hpp"

/// Ornaments of stone and iron.
namespace voxdag::scenes::courtyard {

void rosette(Builder& b, const Detail& d, double radius) {
  const double r = radius;
  // The axis of the turned rim points out of the wall.
  const Frame outwards{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
  b.at(outwards, [&] {
    b.lathe({{r, -0.01},
             {r, 0.05},
             {0.96 * r, 0.08},
             {0.88 * r, 0.08},
             {0.84 * r, 0.05},
             {0.82 * r, 0.03}},
            d(48, 12));
    // Two rings of petals: a relief over the disc.
    const int nr = d(28, 8), nt = d(96, 24);
    b.surface(nt, nr, true, false, [&](int i, int j) {
      const double t = -static_cast<double>(i) / nt, s = 1 - static_cast<double>(j) / nr;
      const double outer = std::abs(sin_turns(4 * t)), inner = std::abs(cos_turns(4 * t));
      const double petal =
          smoothstep(0.98, 0.6, s) * smoothstep(0.3, 0.55, s) * std::sqrt(outer) * 0.055 * r / 0.3;
      const double heart =
          smoothstep(0.62, 0.4, s) * smoothstep(0.12, 0.24, s) * std::sqrt(inner) * 0.075 * r / 0.3;
      const double knob = 0.085 * r / 0.3 * std::sqrt(std::max(0.0, 1 - s * s / 0.03));
      const double y = 0.03 + std::max(petal, std::max(heart, knob));
      return Vec3d{0.82 * r * s * cos_turns(t), y, 0.82 * r * s * sin_turns(t)};
    });
  });
}

void lantern(Builder& b, const Detail& d, double chain) {
  b.material("metal");
  const double link = 0.075;
  const int links = static_cast<int>(chain / link);
  for (int i = 0; i < links; ++i)
    b.at(placed({0, -(i + 0.5) * link, 0}, 0.25 * (i % 2)), [&] {
      const int n = d(16, 8);
      std::vector<Vec3d> loop;
      for (int k = 0; k <= n; ++k) {
        const double t = static_cast<double>(k) / n;
        loop.push_back({0.022 * cos_turns(t), 0.045 * sin_turns(t), 0});
      }
      b.tube(loop, 0.0065, d(6, 4));
    });
  b.at({{0, -links * link, 0}}, [&] {
    // A six-sided cage: cap, rim, bars and a flame inside.
    b.lathe({{0.16, -0.2},
             {0.17, -0.19},
             {0.1, -0.12},
             {0.05, -0.06},
             {0.05, -0.03},
             {0.02, 0},
             {0, 0}},
            6);
    b.lathe({{0, -0.62},
             {0.015, -0.6},
             {0.03, -0.57},
             {0.03, -0.55},
             {0.11, -0.5},
             {0.11, -0.48},
             {0, -0.48}},
            6);
    for (int i = 0; i < 6; ++i) {
      const double c = cos_turns(i / 6.0), s = sin_turns(i / 6.0);
      b.tube({{0.15 * c, -0.195, 0.15 * s}, {0.1 * c, -0.485, 0.1 * s}}, 0.007, d(6, 4));
    }
    b.material("flame");
    b.lathe(
        rounded({{0, -0.48}, {0.03, -0.45}, {0.035, -0.42}, {0.015, -0.36}, {0, -0.32}}, d(3, 2)),
        d(14, 6));
  });
}

void amphora(Builder& b, const Detail& d, double height) {
  const double h = height;
  b.lathe(rounded({{0, 0},
                   {0.17 * h, 0},
                   {0.17 * h, 0.03 * h},
                   {0.08 * h, 0.07 * h},
                   {0.09 * h, 0.1 * h},
                   {0.22 * h, 0.26 * h},
                   {0.3 * h, 0.46 * h},
                   {0.29 * h, 0.6 * h},
                   {0.2 * h, 0.75 * h},
                   {0.145 * h, 0.84 * h},
                   {0.15 * h, 0.92 * h},
                   {0.22 * h, 0.97 * h},
                   {0.225 * h, h},
                   {0.19 * h, h},
                   {0.13 * h, 0.9 * h},
                   {0.12 * h, 0.82 * h},
                   {0, 0.8 * h}},
                  d(4, 2)),
          d(56, 10));
  for (const double y : {0.5, 0.56})
    b.at({{0, y * h, 0}}, [&] { b.torus(0.303 * h, 0.012 * h, d(56, 10), d(8, 4)); });
  for (const double s : {-1.0, 1.0}) {
    const Profile bow =
        rounded({{0.17, 0.9}, {0.27, 0.93}, {0.35, 0.86}, {0.34, 0.74}, {0.27, 0.66}}, d(6, 3));
    std::vector<Vec3d> path;
    for (const Point2 p : bow) path.push_back({s * p.x * h, p.y * h, 0});
    b.tube(path, 0.022 * h, d(10, 5));
  }
}

void bench(Builder& b, const Detail& d) {
  b.material("marble");
  for (const double x : {-0.62, 0.62})
    b.at({{x, 0, 0}}, [&] {
      const double h = 0.4;
      b.square({{0.2, 0},
                {0.2, 0.06},
                {0.15, 0.08},
                {0.12, 0.2},
                {0.15, 0.34},
                {0.19, 0.36},
                {0.19, h},
                {0, h}});
    });
  const int n = d(6, 3);
  Profile edge;  // counter-clockwise: a slab with round edges, swept along x
  for (int i = 0; i <= n; ++i) {
    const double t = -0.25 + 0.5 * i / n;
    edge.push_back({0.24 + 0.04 * cos_turns(t), 0.44 + 0.04 * sin_turns(t)});
  }
  for (int i = 0; i <= n; ++i) {
    const double t = 0.25 + 0.5 * i / n;
    edge.push_back({-0.24 + 0.04 * cos_turns(t), 0.44 + 0.04 * sin_turns(t)});
  }
  const Frame start{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}, {-1, 0, 0}};
  Frame end = start;
  end.origin.x = -1;
  b.sweep(edge, {start, end}, false, true);
  std::vector<Vec3d> cap;
  for (const Point2 p : edge) cap.push_back({1, p.y, p.x});
  b.fan({cap.rbegin(), cap.rend()});
  for (Vec3d& p : cap) p.x = -1;
  b.fan(cap);
}

}  // namespace voxdag::scenes::courtyard
