#include <algorithm>
#include <cmath>

#include "voxdag/formats/scenes/courtyard_parts.hpp"

/// Plants: every leaf is a surface of its own.
namespace voxdag::scenes::courtyard {

void agave(Builder& b, const Detail& d, Random& random, double size) {
  b.material("leaf");
  const int leaves = 34;
  for (int i = 0; i < leaves; ++i) {
    const double age = static_cast<double>(i) / leaves;  // young leaves are upright, old ones bend
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
        const Point2 p = spine[v];
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
  const double crown = height * 0.3, middle = height - crown;
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
  const int leaves = static_cast<int>(6500 * std::min(d.scale, 4.0)) + 200;
  for (int i = 0; i < leaves; ++i) {
    const Vec3d n = random.direction();
    const double lumps = 1 + 0.12 * noise(n * 2.5, 77);
    const double r = crown * lumps * std::sqrt(random.uniform(0.45, 1.0));
    const Vec3d c = Vec3d{0, middle, 0} + n * r;
    const Vec3d along = normalized(random.direction() + n * 0.7),
                across = normalized(cross(along, random.direction()));
    const double l = random.uniform(0.032, 0.055), w = l * 0.45;
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

}  // namespace voxdag::scenes::courtyard
