#include <algorithm>
#include <cmath>

#include "voxdag/formats/scenes/courtyard_parts.hpp"

/// Columns in the classical orders: attic base, shaft with entasis, leafy capital.
namespace voxdag::scenes::courtyard {
namespace {

/// Draws an attic base, one radius high: plinth, torus, hollow, torus.
void attic_base(Builder& b, const Detail& d, double r) {
  const double w = 1.42 * r;
  b.square({{w, 0}, {w, 0.28 * r}, {w - 0.03 * r, 0.32 * r}, {0, 0.32 * r}});
  Profile p = {{1.3 * r, 0.32 * r}};
  const auto torus = [&](double radius, double y, double half) {
    const int n = d(8, 4);
    for (int i = 0; i <= n; ++i) {
      const double t = -0.25 + 0.5 * i / n;
      p.push_back({radius + half * cos_turns(t), y + half * sin_turns(t)});
    }
  };
  torus(1.24 * r, 0.46 * r, 0.14 * r);
  p.push_back({1.16 * r, 0.63 * r});
  p.push_back({1.1 * r, 0.7 * r});
  p.push_back({1.12 * r, 0.78 * r});
  torus(1.12 * r, 0.87 * r, 0.09 * r);
  p.push_back({1.0 * r, 1.0 * r});
  b.lathe(p, d(40, 8));
}

/// Draws a leaf that follows the bell upwards and curls outwards at its tip.
void capital_leaf(Builder& b, const Detail& d, double radius, double height, double width) {
  const int nu = d(8, 4), nv = d(14, 5);
  const auto front = [&](double u, double v) {
    // Up to 0.7 of its length it follows the bell, then it bends over in half a circle.
    const double bend = std::max(0.0, v - 0.7) / 0.3, curl = 0.16 * height;
    const double out = curl * (1 - cos_turns(0.42 * bend)) + 0.06 * height * v;
    const double y = height * std::min(v, 0.7) / 0.84 + curl * sin_turns(0.42 * bend);
    const double lobes = 0.86 + 0.14 * cos_turns(4.5 * v);
    const double half = width * (1 - 0.55 * v * v) * lobes * (v > 0.98 ? 0.5 : 1.0);
    const double rib = 0.05 * height * (1 - u * u) + 0.018 * height * cos_turns(2.5 * u);
    return Vec3d{half * u, y, radius + out + rib - 0.35 * half * u * u};
  };
  b.surface(nu, nv, false, false,
            [&](int i, int j) { return front(2.0 * i / nu - 1, static_cast<double>(j) / nv); });
}

void volute(Builder& b, const Detail& d, double size) {
  const int n = d(36, 12);
  std::vector<Vec3d> path;
  std::vector<double> radii;
  for (int i = 0; i <= n; ++i) {
    const double t = static_cast<double>(i) / n, r = size * (1 - 0.82 * t);
    path.push_back({0, r * sin_turns(1.9 * t + 0.1), -r * cos_turns(1.9 * t + 0.1)});
    radii.push_back(size * 0.26 * (1 - 0.5 * t));
  }
  b.tube(path, radii, d(8, 5));
}

/// Draws two rows of leaves on a bell, and volutes under the corners of an abacus with hollow
/// sides.
void leafy_capital(Builder& b, const Detail& d, double r, double height) {
  const double h = height;
  b.lathe(rounded({{0.98 * r, -0.05 * h},
                   {1.12 * r, 0},
                   {0.98 * r, 0.05 * h},
                   {0.95 * r, 0.3 * h},
                   {1.0 * r, 0.6 * h},
                   {1.3 * r, 0.84 * h}},
                  d(3, 2)),
          d(40, 8));
  for (int row = 0; row < 2; ++row)
    for (int i = 0; i < 8; ++i)
      b.at(placed({0, 0.04 * h, 0}, (i + 0.5 * row) / 8), [&] {
        capital_leaf(b, d, (row == 0 ? 1.0 : 0.94) * r, (row == 0 ? 0.46 : 0.74) * h, 0.33 * r);
      });
  for (int i = 0; i < 4; ++i)
    b.at(placed({0, 0, 0}, 0.125 + 0.25 * i), [&] {
      b.at({{0, 0.7 * h, 1.42 * r}}, [&] { volute(b, d, 0.15 * h); });
    });
  // The abacus: a square whose sides curve in.
  const auto hollow = [](double t, int) {
    const double c = std::max(std::abs(cos_turns(t)), std::abs(sin_turns(t)));
    return (1.0 - 0.16 * c) / (c * 0.86);
  };
  const double w = 1.32 * r;
  b.carved_lathe(
      {{0, 0.86 * h}, {w * 0.94, 0.86 * h}, {w * 0.94, 0.9 * h}, {w, 0.93 * h}, {w, h}, {0, h}},
      4 * d(8, 2), hollow, 0.125);
}

}  // namespace

void corinthian_column(Builder& b, const Detail& d, double height, double radius) {
  const double r = radius, capital = 2.1 * r;
  attic_base(b, d, r);
  // Flutes run from just above the base to just below the capital and end in round scoops.
  const int rings = d(24, 6), flutes = 20;
  Profile shaft;
  for (int i = 0; i <= rings; ++i) {
    const double t = static_cast<double>(i) / rings;
    shaft.push_back({r * (1 - 0.15 * t * t), lerp(r, height - capital, t)});
  }
  b.carved_lathe(shaft, flutes * d(6, 4), [&](double t, int j) {
    const double along = static_cast<double>(j) / rings;
    const double depth = smoothstep(0.02, 0.08, along) * smoothstep(0.0, 0.06, 0.98 - along);
    const double across = cos_turns(t * flutes);
    return 1 - 0.075 * depth * std::max(0.0, across + 0.35);
  });
  b.at({{0, height - capital, 0}}, [&] { leafy_capital(b, d, 0.85 * r, capital); });
}

void slender_column(Builder& b, const Detail& d, double height, double radius) {
  const double r = radius, top = height - 2 * r;
  attic_base(b, d, r);
  // A twisted shaft.
  const int rings = d(40, 6);
  Profile shaft;
  for (int i = 0; i <= rings; ++i)
    shaft.push_back({r * 0.92, lerp(r, top, static_cast<double>(i) / rings)});
  b.carved_lathe(shaft, 4 * d(8, 3), [&](double t, int j) {
    const double along = static_cast<double>(j) / rings;
    const double twist = smoothstep(0.0, 0.06, along) * smoothstep(0.0, 0.06, 1 - along);
    return 1 - 0.1 * twist * (1 - cos_turns(4 * t + 3 * along)) * 0.9;
  });
  b.lathe(rounded({{0.95 * r, top},
                   {1.15 * r, top + 0.1 * r},
                   {0.98 * r, top + 0.25 * r},
                   {1.02 * r, top + 0.7 * r},
                   {1.4 * r, top + 1.45 * r}},
                  d(3, 2)),
          d(28, 8));
  for (int i = 0; i < 8; ++i)
    b.at(placed({0, top + 0.22 * r, 0}, i / 8.0),
         [&] { capital_leaf(b, d, r, 1.15 * r, 0.36 * r); });
  const double w = 1.5 * r;
  b.square({{0, top + 1.42 * r},
            {w * 0.9, top + 1.42 * r},
            {w, top + 1.6 * r},
            {w, height},
            {0, height}});
}

void square_pier(Builder& b, double height, double half_width) {
  const double w = half_width;
  b.square({{w + 0.08, 0},
            {w + 0.08, 0.3},
            {w + 0.04, 0.36},
            {w + 0.05, 0.42},
            {w, 0.48},
            {w, height - 0.42},
            {w + 0.03, height - 0.38},
            {w, height - 0.34},
            {w, height - 0.24},
            {w + 0.07, height - 0.12},
            {w + 0.07, height},
            {0, height}});
}

void baluster(Builder& b, const Detail& d, double height) {
  const double h = height;
  b.square({{0.075, 0}, {0.075, 0.07 * h}, {0, 0.07 * h}});
  b.lathe(rounded({{0.05, 0.07 * h},
                   {0.062, 0.1 * h},
                   {0.04, 0.14 * h},
                   {0.036, 0.17 * h},
                   {0.066, 0.27 * h},
                   {0.07, 0.34 * h},
                   {0.052, 0.46 * h},
                   {0.03, 0.62 * h},
                   {0.026, 0.72 * h},
                   {0.04, 0.78 * h},
                   {0.03, 0.82 * h},
                   {0.05, 0.9 * h},
                   {0.055, 0.93 * h}},
                  d(3, 1)),
          d(16, 6));
  b.square({{0, 0.93 * h}, {0.075, 0.93 * h}, {0.075, h}, {0, h}});
}

}  // namespace voxdag::scenes::courtyard
