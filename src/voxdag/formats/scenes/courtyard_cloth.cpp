#include <cmath>

#include "voxdag/formats/scenes/courtyard_parts.hpp"

/// Cloth. Each piece is a single sheet whose depth follows the folds; the folds are deeper where
/// the cloth is gathered.
namespace voxdag::scenes::courtyard {
namespace {

/// Draws a sheet between the edges left(v) and right(v), v = 0 at the top, with `folds` folds.
template <class Left, class Right>
void sheet(Builder& b, const Detail& d, Random& random, int folds, double top, double bottom,
           const Left& left, const Right& right) {
  const std::uint32_t seed = random.next();
  const double full = right(0.0) - left(0.0);
  const int nu = folds * d(10, 4), nv = d(72, 8);
  b.surface(nu, nv, false, false, [&](int i, int j) {
    const double u = static_cast<double>(i) / nu, v = 1 - static_cast<double>(j) / nv;
    const double gathered = 1 - (right(v) - left(v)) / (full * 1.15);
    const double sway = noise({u * 3, v * 2.2, 0.5}, seed);
    const double wander = 0.55 * noise({u * folds * 0.35, v * 1.4, 7.5}, seed);
    const double depth = full / folds * (0.22 + 0.5 * gathered) * (0.75 + 0.5 * sway);
    const double fold = cos_turns(u * folds + wander);
    const double side = 0.25 * full / folds * sin_turns(2 * (u * folds + wander)) * (1 - gathered);
    const double hem = 0.015 * noise({u * folds, 3.5, 1.5}, seed);
    return Vec3d{lerp(left(v), right(v), u) + side, lerp(top, bottom, v) + (v > 0.99 ? hem : 0),
                 depth * fold + 0.06 * sway * v};
  });
}

void rod(Builder& b, const Detail& d, double width, double y) {
  b.material("metal");
  b.tube({{-0.02, y, 0}, {width + 0.02, y, 0}}, 0.022, d(12, 6));
  const int rings = 14;
  for (int i = 0; i < rings; ++i)
    b.at({{width * (i + 0.5) / rings, y - 0.012, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}},
         [&] { b.torus(0.038, 0.006, d(16, 8), d(6, 4)); });
}

}  // namespace

void tied_curtains(Builder& b, const Detail& d, Random& random, double width, double top) {
  rod(b, d, width, top);
  const double tie = 0.56, half = width / 2;
  // Returns the width of the cloth: full at the rod, gathered at the tie, wider below.
  const auto reach = [&](double v) {
    if (v < tie) {
      const double t = v / tie;
      return lerp(half * 0.98, 0.2, t * t * (1.6 - 0.6 * t));
    }
    return lerp(0.2, 0.5, smoothstep(0.0, 1.0, (v - tie) / (1 - tie)));
  };
  b.material("curtain");
  const auto zero = [](double) { return 0.02; };
  sheet(b, d, random, 9, top - 0.05, 0.03, zero, reach);
  sheet(
      b, d, random, 9, top - 0.05, 0.03, [&](double v) { return width - reach(v); },
      [&](double) { return width - 0.02; });
  b.material("metal");
  for (const double x : {0.11, width - 0.11})
    b.at({{x, top * (1 - tie), 0}}, [&] { b.torus(0.125, 0.022, d(28, 8), d(8, 4)); });
}

void drawn_curtain(Builder& b, const Detail& d, Random& random, double width, double top) {
  rod(b, d, width, top);
  b.material("curtain");
  sheet(
      b, d, random, 13, top - 0.05, 0.03, [&](double v) { return 0.03 + 0.05 * v; },
      [&](double v) { return width - 0.03 - 0.08 * v * v; });
}

void banner(Builder& b, const Detail& d, Random& random, double width, double drop) {
  const std::uint32_t seed = random.next();
  b.material("metal");
  b.tube({{-width / 2 - 0.08, 0, 0.05}, {width / 2 + 0.08, 0, 0.05}}, 0.02, d(10, 6));
  for (const double s : {-1.0, 1.0})
    b.at({{s * (width / 2 + 0.1), 0, 0.05}}, [&] { b.ball(d(6, 3), [](Vec3d) { return 0.04; }); });
  b.material("banner");
  const int nu = d(40, 8), nv = d(64, 8);
  const auto at = [&](double u, double v) {
    const double point = 0.22 * (1 - std::abs(2 * u - 1));
    const double wave =
        0.05 * v * noise({u * 2.2, v * 1.6, 0.5}, seed) + 0.022 * v * cos_turns(u * 2.5 + 0.4 * v);
    return Vec3d{(u - 0.5) * width * (1 - 0.04 * v), -v * drop * (0.88 + point * 0.55),
                 0.075 + wave};
  };
  b.surface(nu, nv, false, false, [&](int i, int j) {
    return at(static_cast<double>(i) / nu, 1 - static_cast<double>(j) / nv);
  });
  b.material("fringe");
  const int tassels = d(34, 8);
  for (int i = 0; i <= tassels; ++i) {
    const Vec3d p = at(static_cast<double>(i) / tassels, 1);
    b.tube({p, p - Vec3d{0, 0.05, -0.004}, p - Vec3d{0, 0.09, 0.002}}, {0.006, 0.009, 0.004},
           d(5, 3));
  }
}

}  // namespace voxdag::scenes::courtyard
