#include <algorithm>
#include <cmath>

#include "voxdag/formats/scenes/city_parts.hpp"

/// Walls with openings. A wall is a grid of cells; each cell is a frame around a recessed pane.
namespace voxdag::scenes::city {
namespace {

/// Draws a cell of the wall z = 0, [x0,x1] x [y0,y1], with a recess [a0,a1] x [c0,c1].
void opening(Builder& b, double x0, double x1, double y0, double y1, double a0, double a1,
             double c0, double c1, double depth, const char* wall, const char* pane) {
  b.material(wall);
  const Vec3d outer[4] = {{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}};
  const Vec3d inner[4] = {{a0, c0, 0}, {a1, c0, 0}, {a1, c1, 0}, {a0, c1, 0}};
  const Vec3d back{0, 0, -depth};
  for (int i = 0; i < 4; ++i) {
    const int j = (i + 1) % 4;
    b.quad(outer[i], outer[j], inner[j], inner[i]);
    b.quad(inner[i], inner[j], inner[j] + back, inner[i] + back);
  }
  b.material(pane);
  b.quad(inner[0] + back, inner[1] + back, inner[2] + back, inner[3] + back);
}

void window(Builder& b, double x0, double x1, double y0, double y1, const Style& s) {
  const double w = (x1 - x0) * (1 - s.window_width) / 2, h = (y1 - y0) * (1 - s.window_height);
  const double a0 = x0 + w, a1 = x1 - w, c0 = y0 + h * 0.7, c1 = y1 - h * 0.3, d = s.recess;
  opening(b, x0, x1, y0, y1, a0, a1, c0, c1, d, s.wall, "glass");
  b.material("frame");
  const double middle = (a0 + a1) / 2;
  b.box({middle - 0.04, c0, -d - 0.02}, {middle + 0.04, c1, -d + 0.05});
  b.box({a0, lerp(c0, c1, 0.66) - 0.03, -d - 0.02},
        {middle - 0.04, lerp(c0, c1, 0.66) + 0.03, -d + 0.04});
  b.box({middle + 0.04, lerp(c0, c1, 0.66) - 0.03, -d - 0.02},
        {a1, lerp(c0, c1, 0.66) + 0.03, -d + 0.04});
  if (s.sills) {
    b.material("trim");
    b.box({a0 - 0.12, c0 - 0.14, -0.05}, {a1 + 0.12, c0, 0.16});
    b.box({a0 - 0.08, c1, -0.05}, {a1 + 0.08, c1 + 0.2, 0.08});
  }
}

void balcony(Builder& b, double x0, double x1, double y) {
  b.material("trim");
  b.box({x0, y - 0.18, -0.02}, {x1, y, 1.3});
  b.material("metal");
  b.box({x0 + 0.05, y + 0.95, 1.18}, {x1 - 0.05, y + 1.02, 1.25});
  const int bars = static_cast<int>((x1 - x0) / 0.22);
  for (int i = 0; i <= bars; ++i) {
    const double x = lerp(x0 + 0.06, x1 - 0.06, static_cast<double>(i) / bars);
    b.box({x - 0.02, y, 1.2}, {x + 0.02, y + 0.95, 1.24});
  }
  for (const double x : {x0 + 0.03, x1 - 0.07}) b.box({x, y + 0.95, 0}, {x + 0.04, y + 1.02, 1.18});
}

/// Calls draw(length) in the frame of each edge: x along it, z outwards, y from `bottom`.
template <class Draw>
void each_edge(Builder& b, const Footprint& f, double bottom, const Draw& draw) {
  for (std::size_t i = 0; i < f.size(); ++i) {
    const Point2 p = f[i], q = f[(i + 1) % f.size()];
    const Vec3d along{q.x - p.x, 0, q.y - p.y};
    const double l = length(along);
    const Vec3d x = along * (1 / l);
    b.at({{p.x, bottom, p.y}, x, {0, 1, 0}, {-x.z, 0, x.x}}, [&] { draw(l); });
  }
}

}  // namespace

Footprint rectangle(double x0, double x1, double z0, double z1) {
  return {{x0, z1}, {x1, z1}, {x1, z0}, {x0, z0}};
}

Style random_style(Random& random, bool tower) {
  static constexpr Style kTowers[] = {
      {3.7, 1.9, 0.86, 0.86, 0.12, false, true, false, false, "steel"},
      {3.6, 3.2, 0.72, 0.62, 0.35, false, false, false, false, "concrete"},
      {3.5, 4.8, 0.94, 0.5, 0.3, false, false, false, false, "concrete"},
      {3.6, 2.4, 0.52, 0.78, 0.45, false, true, false, true, "stone"},
  };
  static constexpr Style kHouses[] = {
      {3.4, 2.9, 0.42, 0.58, 0.22, true, false, false, true, "brick"},
      {3.7, 3.1, 0.4, 0.64, 0.28, true, false, true, true, "stucco"},
      {3.2, 3.4, 0.58, 0.52, 0.25, false, false, true, false, "concrete"},
      {3.9, 2.7, 0.46, 0.68, 0.3, true, false, false, true, "stone"},
      {3.2, 4.2, 0.84, 0.46, 0.2, false, false, false, false, "brick"},
  };
  return tower ? kTowers[random.below(4)] : kHouses[random.below(5)];
}

double walls(Builder& b, Random& random, const Footprint& footprint, double bottom, int storeys,
             const Style& style) {
  const int balcony_column = style.balconies ? random.below(3) : -1;
  each_edge(b, footprint, bottom, [&](double l) {
    const int bays = std::max(1, static_cast<int>(l / style.bay));
    const double w = l / bays;
    for (int row = 0; row < storeys; ++row)
      for (int i = 0; i < bays; ++i) {
        const double y = row * style.storey;
        window(b, i * w, (i + 1) * w, y, y + style.storey, style);
        if (i % 3 == balcony_column && row > 0 && bays > 2)
          balcony(b, (i + 0.08) * w, (i + 0.92) * w, y + 0.25);
      }
    if (style.fins) {
      b.material("trim");
      for (int i = 0; i < bays; ++i)
        b.box({i * w - 0.09, 0, -0.05}, {i * w + 0.09, storeys * style.storey, 0.3});
    }
  });
  const double top = bottom + storeys * style.storey;
  if (style.cornices) {
    b.material("trim");
    for (int row = 0; row <= storeys; row += std::max(2, storeys / 3))
      band(b, footprint, bottom + row * style.storey - 0.12,
           {{0, 0}, {0.12, 0.02}, {0.12, 0.14}, {0.18, 0.2}, {0.18, 0.27}, {0, 0.29}});
    band(b, footprint, top - 0.5,
         {{0, 0}, {0.1, 0.04}, {0.14, 0.2}, {0.5, 0.3}, {0.55, 0.5}, {0, 0.52}});
  }
  return top;
}

double shops(Builder& b, Random& random, const Footprint& footprint, double bottom,
             const Style& style) {
  const double height = 4.6;
  each_edge(b, footprint, bottom, [&](double l) {
    const int bays = std::max(1, static_cast<int>(l / 4.2));
    const double w = l / bays;
    for (int i = 0; i < bays; ++i) {
      const double x = i * w;
      const bool door = random.chance(0.3);
      opening(b, x, x + w, 0, height, x + 0.4, x + w - 0.4, door ? 0.05 : 0.7, 3.3, 0.35,
              style.wall, door ? "wood" : "glass");
      b.material("trim");
      b.box({x + 0.3, 3.35, -0.02}, {x + w - 0.3, 3.95, 0.14});
      b.box({x - 0.22, 0, -0.02}, {x + 0.22, height - 0.2, 0.12});
      if (!door && random.chance(0.55)) {
        b.material("awning");
        const Vec3d a{x + 0.35, 3.3, 0.02}, c{x + w - 0.35, 3.3, 0.02}, out{0, -0.75, 1.5},
            up{0, 0.06, 0};
        b.quad(a + out + up, c + out + up, c + up, a + up);
        b.quad(a, c, c + out, a + out);
        b.quad(a + out, c + out, c + out + up, a + out + up);
      }
    }
  });
  b.material("trim");
  band(b, footprint, height + bottom - 0.3,
       {{0, 0}, {0.1, 0.03}, {0.12, 0.15}, {0.28, 0.22}, {0.3, 0.34}, {0, 0.36}});
  return bottom + height;
}

void band(Builder& b, const Footprint& f, double y, const Profile& moulding) {
  std::vector<Frame> path;
  const std::size_t n = f.size();
  for (std::size_t k = n; k-- > 0;) {
    const Point2 before = f[(k + n - 1) % n], here = f[k], after = f[(k + 1) % n];
    const Vec3d d0 = normalized(Vec3d{here.x - before.x, 0, here.y - before.y}),
                d1 = normalized(Vec3d{after.x - here.x, 0, after.y - here.y});
    const Vec3d n0{-d0.z, 0, d0.x}, n1{-d1.z, 0, d1.x};
    path.push_back({{here.x, y, here.y}, (n0 + n1) * (1 / (1 + dot(n0, n1))), {0, 1, 0}, {}});
  }
  b.sweep(moulding, path, true, false);
}

}  // namespace voxdag::scenes::city
