#include <cmath>

#include "voxdag/formats/scenes/courtyard_parts.hpp"

/// Arcade walls and the vaults behind them.
namespace voxdag::scenes::courtyard {

void arch_wall(Builder& b, const Detail& d, double width, double top, double radius,
               double thickness) {
  const double half = thickness / 2, centre = width / 2;
  Profile edge = {{0, 0}};
  const int n = d(32, 8);
  for (int i = 0; i <= n; ++i) {
    const double t = 0.5 - 0.5 * i / n;
    edge.push_back({centre + radius * cos_turns(t), radius * sin_turns(t)});
  }
  edge.push_back({width, 0});
  const int last = static_cast<int>(edge.size()) - 1;
  const auto lower = [&](int i, double z) {
    const Point2 p = edge[i];
    return Vec3d{p.x, p.y, z};
  };
  const auto upper = [&](int i, double z) { return Vec3d{edge[i].x, top, z}; };
  b.surface(last, 1, false, false,
            [&](int i, int j) { return j == 0 ? lower(i, half) : upper(i, half); });
  b.surface(last, 1, false, false,
            [&](int i, int j) { return j == 1 ? lower(i, -half) : upper(i, -half); });
  b.surface(last, 1, false, false, [&](int i, int j) { return lower(i, j == 0 ? -half : half); });
  b.surface(last, 1, false, false, [&](int i, int j) { return upper(i, j == 0 ? half : -half); });
}

void archivolt(Builder& b, const Detail& d, double radius, double band) {
  const double w = band;
  const Profile moulding = {{w, -0.01},       {w, 0.07},       {w - 0.03, 0.085}, {w - 0.06, 0.07},
                            {w - 0.07, 0.05}, {w * 0.5, 0.05}, {w * 0.5, 0.035},  {0.05, 0.035},
                            {0.04, 0.055},    {0.02, 0.06},    {-0.012, 0.05},    {-0.012, -0.01}};
  std::vector<Frame> path;
  const int n = d(32, 8);
  for (int i = 0; i <= n; ++i) {
    const double t = 0.5 - 0.5 * i / n, c = cos_turns(t), s = sin_turns(t);
    path.push_back({{radius * c, radius * s, 0}, {c, s, 0}, {0, 0, 1}, {s, -c, 0}});
  }
  b.sweep(moulding, path, false, false);
  // The keystone: a wedge with a rolled foot.
  const double lo = radius - 0.05, hi = radius + w + 0.08, depth = 0.13;
  const Vec3d a{-0.1, lo, depth}, c{0.1, lo, depth}, e{0.15, hi, depth}, g{-0.15, hi, depth};
  const auto back = [](Vec3d p) { return Vec3d{p.x, p.y, -0.01}; };
  b.quad(a, c, e, g);
  b.quad(back(a), a, g, back(g));
  b.quad(c, back(c), back(e), e);
  b.quad(g, e, back(e), back(g));
  b.quad(back(a), back(c), c, a);
  b.at({{-0.12, lo + 0.04, depth}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}}, [&] {
    b.lathe({{0, 0}, {0.045, 0}, {0.05, 0.02}, {0.05, 0.22}, {0.045, 0.24}, {0, 0.24}}, d(14, 6));
  });
}

void groin_vault(Builder& b, const Detail& d, double width, double depth, double rise) {
  const auto tunnel = [](double u) { return std::sqrt(std::max(0.0, 1 - u * u)); };
  const auto height = [&](double u, double v) { return rise * std::max(tunnel(u), tunnel(v)); };
  // Samples crowd towards the walls, where the ellipse is steep.
  const int n = 2 * d(16, 4);
  const auto spread = [&](int i) { return sin_turns(0.5 * i / n - 0.25); };
  b.surface(n, n, false, false, [&](int i, int j) {
    const double u = spread(i), v = spread(j);
    return Vec3d{width * 0.5 * (1 + u), height(u, v), -depth * 0.5 * (1 - v)};
  });
  for (int diagonal = 0; diagonal < 2; ++diagonal) {
    std::vector<Vec3d> rib;
    const int m = d(24, 8);
    for (int i = 0; i <= m; ++i) {
      const double u = sin_turns(0.5 * i / m - 0.25), v = diagonal == 0 ? u : -u;
      rib.push_back({width * 0.5 * (1 + u), height(u, v), -depth * 0.5 * (1 - v)});
    }
    b.tube(rib, 0.06, d(10, 5));
  }
  b.at({{width / 2, rise - 0.1, -depth / 2}}, [&] {
    b.lathe({{0, 0}, {0.06, 0}, {0.1, 0.03}, {0.1, 0.05}, {0.15, 0.07}, {0.15, 0.11}}, d(24, 8));
  });
}

}  // namespace voxdag::scenes::courtyard
