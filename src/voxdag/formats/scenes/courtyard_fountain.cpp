#include <cmath>

#include "voxdag/formats/scenes/courtyard_parts.hpp"

/// A pool with two scalloped basins above it and water running down.
namespace voxdag::scenes::courtyard {
namespace {

/// Draws a bowl with a scalloped rim on a stem; `r` is the radius, the rim lies at y = 0.
void basin(Builder& b, const Detail& d, double r, int lobes) {
  const Profile p = rounded({{0.14 * r, -0.42 * r},
                             {0.2 * r, -0.4 * r},
                             {0.55 * r, -0.3 * r},
                             {0.9 * r, -0.1 * r},
                             {0.97 * r, -0.02 * r},
                             {1.03 * r, -0.01 * r},
                             {1.03 * r, 0.03 * r},
                             {0.97 * r, 0.03 * r},
                             {0.88 * r, -0.06 * r},
                             {0.5 * r, -0.2 * r},
                             {0, -0.24 * r}},
                            d(4, 2));
  b.carved_lathe(p, lobes * d(8, 4), [&](double t, int j) {
    const double out = p[j].x / r;
    return 1 + 0.07 * smoothstep(0.25, 0.8, out) * (std::abs(cos_turns(t * lobes * 0.5)) - 0.6);
  });
}

void water_disc(Builder& b, const Detail& d, double radius, double y, double height,
                std::uint32_t seed) {
  b.material("water");
  const int nr = d(40, 6), nt = d(96, 12);
  b.surface(nt, nr, true, false, [&](int i, int j) {
    const double t = -static_cast<double>(i) / nt, r = radius * (1 - static_cast<double>(j) / nr);
    const double ripple =
        height * (cos_turns(r * 5.5) / (1 + 2 * r) +
                  0.6 * noise({r * cos_turns(t) * 4, 0, r * sin_turns(t) * 4}, seed));
    return Vec3d{r * cos_turns(t), y + ripple, r * sin_turns(t)};
  });
}

void jets(Builder& b, const Detail& d, int count, double from_r, double from_y, double to_r,
          double to_y, double phase) {
  b.material("water");
  const int n = d(16, 6);
  for (int i = 0; i < count; ++i)
    b.at(placed({}, (i + phase) / count), [&] {
      std::vector<Vec3d> path;
      std::vector<double> radii;
      for (int k = 0; k <= n; ++k) {
        const double t = static_cast<double>(k) / n;
        path.push_back({0, lerp(from_y, to_y, t * t) + 0.08 * t * (1 - t), lerp(from_r, to_r, t)});
        radii.push_back(lerp(0.016, 0.009, t));
      }
      b.tube(path, radii, d(8, 4));
    });
}

}  // namespace

void fountain(Builder& b, const Detail& d, Random& random) {
  b.material("marble");
  // An eight-sided pool wall on two steps, turned by half a side.
  const auto octagon = [&](const Profile& p) {
    b.carved_lathe(
        p, 8, [](double, int) { return 1.0823922; }, 1.0 / 16);
  };
  octagon({{2.9, 0}, {2.9, 0.1}, {2.87, 0.12}, {2.5, 0.12}});
  octagon({{2.55, 0.1}, {2.55, 0.22}, {2.52, 0.24}, {2.1, 0.24}});
  octagon({{2.12, 0.2},
           {2.12, 0.3},
           {2.06, 0.36},
           {2.0, 0.38},
           {2.0, 0.62},
           {2.03, 0.64},
           {2.05, 0.67},
           {2.1, 0.7},
           {2.1, 0.76},
           {2.07, 0.79},
           {1.8, 0.79},
           {1.78, 0.76},
           {1.78, 0.3},
           {0, 0.3}});
  for (int i = 0; i < 8; ++i)
    b.at(placed({}, i / 8.0), [&] { b.at({{0, 0.5, 2.0}}, [&] { rosette(b, d, 0.105); }); });
  water_disc(b, d, 1.79, 0.62, 0.008, random.next());

  b.material("marble");
  b.lathe(rounded({{0.5, 0.3},
                   {0.5, 0.66},
                   {0.42, 0.7},
                   {0.36, 0.72},
                   {0.2, 0.86},
                   {0.17, 1.0},
                   {0.24, 1.1},
                   {0.18, 1.18},
                   {0.14, 1.25}},
                  d(4, 2)),
          d(40, 10));
  b.at({{0, 1.62, 0}}, [&] { basin(b, d, 0.95, 16); });
  b.lathe(rounded({{0.22, 1.38},
                   {0.2, 1.5},
                   {0.12, 1.6},
                   {0.1, 1.75},
                   {0.16, 1.85},
                   {0.1, 1.93},
                   {0.07, 2.05}},
                  d(4, 2)),
          d(32, 8));
  b.at({{0, 2.24, 0}}, [&] { basin(b, d, 0.5, 12); });
  // A pine cone on top.
  const Profile cone = rounded(
      {{0.1, 2.12}, {0.06, 2.2}, {0.11, 2.26}, {0.14, 2.36}, {0.12, 2.48}, {0.06, 2.6}, {0, 2.66}},
      d(8, 3));
  b.carved_lathe(cone, d(48, 12), [&](double t, int j) {
    const double y = cone[j].y;
    return 1 +
           0.12 * smoothstep(2.24, 2.3, y) * cos_turns(8 * t + 12 * y) * cos_turns(8 * t - 12 * y);
  });
  b.at({{0, 1.575, 0}}, [&] { water_disc(b, d, 0.88, 0, 0.005, random.next()); });
  b.at({{0, 2.215, 0}}, [&] { water_disc(b, d, 0.46, 0, 0.004, random.next()); });
  jets(b, d, 16, 0.96, 1.62, 1.35, 0.62, 0);
  jets(b, d, 12, 0.5, 2.24, 0.72, 1.58, 0.5);
}

}  // namespace voxdag::scenes::courtyard
