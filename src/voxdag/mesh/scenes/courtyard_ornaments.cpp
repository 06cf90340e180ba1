#include <cmath>

#include "voxdag/mesh/scenes/courtyard_parts.hpp"

/// Carved and wrought things.
namespace voxdag::scenes::courtyard {

void rosette(Builder& b, const Detail& d, double radius) {
  const double r = radius;
  // The axis of the turned rim looks out of the wall.
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

void agave(Builder& b, const Detail& d, Random& random, double size) {
  b.material("leaf");
  const int leaves = 34;
  for (int i = 0; i < leaves; ++i) {
    const double age = static_cast<double>(i) / leaves;  // young leaves stand, old ones bend
    const double l = size * lerp(0.75, 1.0, age) * random.uniform(0.85, 1.1);
    const double start = lerp(0.235, 0.06, age) + random.uniform(-0.015, 0.015);
    const double bend = lerp(0.05, 0.22, age) + random.uniform(0, 0.05);
    b.at(placed({0, 0, 0}, i * 0.381966), [&] {
      const int nv = d(14, 5);
      std::vector<Point2> spine = {{0.02 * size, 0}};
      for (int k = 0; k < nv; ++k) {
        const double angle = start - bend * k / nv;
        spine.push_back({spine.back().x + l / nv * cos_turns(angle),
                         spine.back().y + l / nv * sin_turns(angle)});
      }
      b.surface(2, nv, false, false, [&](int u, int v) {
        const double t = static_cast<double>(v) / nv;
        const double half = 0.075 * size * (1 - t * t) * smoothstep(-0.6, 0.4, t) + 0.001;
        const Point2 p = spine[static_cast<std::size_t>(v)];
        return Vec3d{(u - 1) * half, p.y + (u == 1 ? -0.35 * half : 0), p.x};
      });
    });
  }
}

void potted_tree(Builder& b, const Detail& d, Random& random, double height) {
  b.material("terracotta");
  b.square({{0.34, 0},
            {0.38, 0.05},
            {0.36, 0.08},
            {0.44, 0.58},
            {0.48, 0.6},
            {0.48, 0.7},
            {0.42, 0.7},
            {0.41, 0.6},
            {0, 0.6}});
  b.material("bark");
  const double crown = height * 0.36, middle = height - crown;
  std::vector<Vec3d> trunk;
  for (int i = 0; i <= 10; ++i) {
    const double t = i / 10.0;
    trunk.push_back({0.05 * sin_turns(0.9 * t), lerp(0.58, middle, t),
                     0.04 * sin_turns(0.7 * t + 0.2) - 0.038});
  }
  b.tube(trunk, 0.045, d(10, 6));
  for (int i = 0; i < 14; ++i) {
    const Vec3d tip = random.direction() * (crown * 0.8);
    const Vec3d from = trunk[8], to = Vec3d{0, middle, 0} + tip;
    b.tube({from, lerp(from, to, 0.5) + Vec3d{0, 0.05, 0}, to}, {0.025, 0.015, 0.006}, d(6, 4));
  }
  b.material("leaf");
  const int leaves = static_cast<int>(2600 * std::min(d.scale, 4.0)) + 200;
  for (int i = 0; i < leaves; ++i) {
    const Vec3d n = random.direction();
    const double lumps = 1 + 0.12 * noise(n * 2.5, 77);
    const double r = crown * lumps * std::sqrt(random.uniform(0.45, 1.0));
    const Vec3d c = Vec3d{0, middle, 0} + n * r;
    const Vec3d along = normalize(random.direction() + n * 0.7),
                across = normalize(cross(along, random.direction()));
    const double l = random.uniform(0.05, 0.085), w = l * 0.42;
    const Vec3d fold = cross(along, across) * (w * 0.35);
    const std::uint32_t tip = b.vertex(c + along * l), stem = b.vertex(c - along * l);
    const std::uint32_t rib = b.vertex(c - fold);
    const std::uint32_t left = b.vertex(c - across * w), right = b.vertex(c + across * w);
    b.triangle(stem, rib, left);
    b.triangle(rib, tip, left);
    b.triangle(stem, right, rib);
    b.triangle(rib, right, tip);
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
