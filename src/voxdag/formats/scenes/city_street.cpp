#include <cmath>

#include "voxdag/formats/scenes/city_parts.hpp"

namespace voxdag::scenes::city {

void tree(Builder& b, Random& random, double height) {
  b.material("bark");
  const double crown = height * 0.33, middle = height - crown;
  b.tube({{0, -0.1, 0}, {0.06, middle * 0.5, 0.03}, {0, middle, 0}},
         {height * 0.028, height * 0.02, height * 0.01}, 7);
  b.material("leaf");
  // Sprays of leaves near the surface of a few overlapping balls.
  const int lumps = 3 + random.below(3);
  for (int i = 0; i < lumps; ++i) {
    const Vec3d centre = Vec3d{0, middle, 0} + random.direction() * (crown * 0.45);
    const double r = crown * random.uniform(0.5, 0.75);
    for (int k = 0; k < 110; ++k) {
      const Vec3d out = random.direction();
      const Vec3d c = centre + out * (r * std::sqrt(random.uniform(0.4, 1)));
      const Vec3d along = normalized(random.direction() + out * 0.4);
      const Vec3d across = normalized(cross(along, random.direction()));
      const double l = random.uniform(0.2, 0.38), w = l * 0.6;
      b.quad(c - along * l, c + across * w, c + along * l, c - across * w);
    }
  }
}

void street_lamp(Builder& b) {
  b.material("metal");
  b.lathe({{0.16, 0}, {0.16, 0.5}, {0.1, 0.62}, {0.08, 3}, {0.06, 7.2}, {0, 7.25}}, 8);
  b.tube({{0, 7.0, 0}, {0, 7.6, 0.3}, {0, 7.8, 1.0}, {0, 7.75, 2.0}}, 0.045, 6);
  b.box({-0.14, 7.62, 1.8}, {0.14, 7.76, 2.7});
}

void car(Builder& b, Random& random) {
  const double roof = random.uniform(1.4, 1.75), back = random.uniform(-2.1, -1.3);
  // The side view, counter-clockwise with x forwards.
  const Profile body = {{-2.2, 0.3}, {2.15, 0.3},  {2.25, 0.45}, {2.2, 0.72},
                        {1.2, 0.92}, {-1.9, 0.98}, {-2.25, 0.9}, {-2.3, 0.5}};
  const Profile cabin = {
      {-1.95, 0.95}, {1.15, 0.9}, {0.35, roof}, {back + 0.5, roof + 0.03}, {back, roof - 0.15}};
  const auto slab = [&](const Profile& side, double half, double inset) {
    const int n = static_cast<int>(side.size());
    std::vector<Vec3d> left, right;
    for (const Point2 p : side) {
      const double w = half - inset * (p.y - side.front().y);
      left.push_back({p.x, p.y, w});
      right.push_back({p.x, p.y, -w});
    }
    b.fan(left);
    b.fan({right.rbegin(), right.rend()});
    b.surface(n, 1, true, false, [&](int i, int j) { return (j == 0 ? left : right)[i]; });
  };
  b.material("paint");
  slab(body, 0.9, 0);
  b.material("glass");
  slab(cabin, 0.84, 0.3);
  b.material("rubber");
  for (const double x : {-1.4, 1.4})
    for (const double s : {-1.0, 1.0})
      b.at({{x, 0.33, s * 0.78}, {1, 0, 0}, {0, 0, s}, {0, -s, 0}}, [&] {
        b.lathe({{0, -0.1}, {0.33, -0.1}, {0.33, 0.12}, {0.2, 0.14}, {0.18, 0.11}, {0, 0.11}}, 14);
      });
}

void park(Builder& b, Random& random, double half_x, double half_z) {
  b.material("grass");
  const std::uint32_t shape = random.next();
  // Lawns with gentle mounds between two crossing paths.
  const auto lawn = [&](double x0, double x1, double z0, double z1) {
    const int n = 16;
    b.surface(n, n, false, false, [&](int i, int j) {
      const double u = static_cast<double>(j) / n, v = static_cast<double>(i) / n;
      const double x = lerp(x0, x1, u), z = lerp(z0, z1, v), edge = 16 * u * (1 - u) * v * (1 - v);
      return Vec3d{x, 0.06 + edge * (0.5 + 0.6 * noise({x / 11, 0.5, z / 11}, shape)), z};
    });
  };
  for (const double sx : {-1.0, 1.0})
    for (const double sz : {-1.0, 1.0}) {
      const double ax = sx < 0 ? -half_x : 3.0, bx = sx < 0 ? -3.0 : half_x;
      const double az = sz < 0 ? -half_z : 3.0, bz = sz < 0 ? -3.0 : half_z;
      b.material("grass");
      lawn(ax, bx, az, bz);
      for (int i = 0; i < 12; ++i) {
        const double x = random.uniform(ax + 2, bx - 2), z = random.uniform(az + 2, bz - 2);
        if (x * x + z * z < 100) continue;
        b.at(placed({x, 0.1, z}, random.uniform()),
             [&] { tree(b, random, random.uniform(6, 12)); });
      }
    }
  b.material("stone");
  b.lathe({{8, 0}, {8, 0.5}, {7.9, 0.6}, {7.4, 0.6}, {7.3, 0.3}, {0, 0.3}}, 40);
  b.lathe(rounded({{0.9, 0.3},
                   {0.6, 1.2},
                   {0.5, 2.2},
                   {2.2, 2.9},
                   {2.3, 3.1},
                   {0.4, 2.9},
                   {0.3, 4.2},
                   {0.9, 4.6},
                   {0, 5.2}},
                  4),
          28);
}

}  // namespace voxdag::scenes::city
