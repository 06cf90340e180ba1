#include <algorithm>
#include <cmath>

#include "voxdag/formats/scenes/courtyard_parts.hpp"

/// Coverings of walls and floors.
namespace voxdag::scenes::courtyard {

void door(Builder& b, const Detail& d, double width) {
  const double r = width / 2, spring = 2.1;
  b.material("marble");
  for (const double s : {-1.0, 1.0})
    b.at({{s * (r + 0.13), 0, 0}}, [&] {
      b.box({-0.17, 0, -0.02}, {0.17, 0.3, 0.14});
      b.box({-0.13, 0.3, -0.02}, {0.13, spring - 0.14, 0.09});
      b.box({-0.16, spring - 0.14, -0.02}, {0.16, spring, 0.13});
    });
  b.at({{0, spring, 0}}, [&] { archivolt(b, d, r, 0.26); });
  b.box({-r - 0.3, 0, 0}, {r + 0.3, 0.05, 0.3});

  b.material("wood");
  // Two leaves with raised panels; the top is a fan of boards below the arch.
  for (const double s : {-1.0, 1.0}) {
    const double x0 = std::min(s * 0.012, s * r), x1 = std::max(s * 0.012, s * r);
    b.box({x0, 0.05, -0.05}, {x1, spring, 0.03});
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 2; ++column) {
        const double w = (x1 - x0) / 2, h = (spring - 0.15) / 4;
        const double px = x0 + w * column, py = 0.1 + h * row;
        b.at({{px + w / 2, py + h / 2, 0.03}, {1, 0, 0}, {0, 0, 1}, {0, -1, 0}}, [&] {
          b.bevelled_slab({-w * 0.4, 0, -h * 0.4}, {w * 0.4, 0.04, h * 0.4}, 0.028);
        });
      }
  }
  const int fan = 10;
  for (int i = 0; i < fan; ++i) {
    const double t0 = 0.5 * i / fan, t1 = 0.5 * (i + 1) / fan, z = i % 2 == 0 ? 0.03 : 0.015;
    b.fan({{0, spring, z},
           {r * cos_turns(t0), spring + r * sin_turns(t0), z},
           {r * cos_turns(t1), spring + r * sin_turns(t1), z}});
  }
  b.material("metal");
  for (const double s : {-1.0, 1.0})
    b.at({{s * 0.12, 1.05, 0.07}, {1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
         [&] { b.torus(0.05, 0.01, d(20, 8), d(8, 4)); });
}

void shuttered_window(Builder& b, double width, double height) {
  const double w = width / 2, h = height;
  b.material("marble");
  b.box({-w - 0.14, -0.02, -0.02}, {-w, h, 0.07});
  b.box({w, -0.02, -0.02}, {w + 0.14, h, 0.07});
  b.box({-w - 0.14, h, -0.02}, {w + 0.14, h + 0.16, 0.07});
  b.box({-w - 0.22, h + 0.16, -0.02}, {w + 0.22, h + 0.24, 0.15});
  b.box({-w - 0.22, -0.14, -0.02}, {w + 0.22, -0.02, 0.16});
  b.material("wood");
  for (const double s : {-1.0, 1.0}) {
    const double x0 = std::min(s * 0.008, s * w), x1 = std::max(s * 0.008, s * w);
    b.box({x0, 0, -0.02}, {x0 + 0.06, h, 0.045});
    b.box({x1 - 0.06, 0, -0.02}, {x1, h, 0.045});
    for (const double y : {0.0, h / 2 - 0.04, h - 0.08})
      b.box({x0 + 0.06, y, -0.02}, {x1 - 0.06, y + 0.08, 0.04});
    for (int half = 0; half < 2; ++half) {
      const double lo = half == 0 ? 0.08 : h / 2 + 0.04, hi = half == 0 ? h / 2 - 0.04 : h - 0.08;
      const int slats = static_cast<int>((hi - lo) / 0.06);
      for (int i = 0; i < slats; ++i)
        b.at({{0, lo + (i + 0.5) * (hi - lo) / slats, 0.012},
              {1, 0, 0},
              {0, cos_turns(0.12), -sin_turns(0.12)},
              {0, sin_turns(0.12), cos_turns(0.12)}},
             [&] {
               b.box({x0 + 0.06, -0.005, -0.03}, {x1 - 0.06, 0.005, 0.03});
             });
    }
  }
}

void paving(Builder& b, Random& random, double x0, double x1, double z0, double z1, double pitch) {
  const int nx = static_cast<int>(std::ceil((x1 - x0) / pitch - 1e-9)),
            nz = static_cast<int>(std::ceil((z1 - z0) / pitch - 1e-9));
  const double wx = (x1 - x0) / nx, wz = (z1 - z0) / nz, joint = 0.008;
  for (int i = 0; i < nx; ++i)
    for (int k = 0; k < nz; ++k) {
      const double top = random.uniform(-0.006, 0);
      b.bevelled_slab({x0 + i * wx + joint, -0.04, z0 + k * wz + joint},
                      {x0 + (i + 1) * wx - joint, top, z0 + (k + 1) * wz - joint}, 0.008);
    }
}

void ashlar(Builder& b, Random& random, double width, double height, Point2 gap,
            double gap_height) {
  const int courses = static_cast<int>(height / 0.45 + 0.5);
  const double h = height / courses, joint = 0.009;
  for (int row = 0; row < courses; ++row) {
    const double y = row * h;
    double x = 0;
    bool half = row % 2 == 1;
    while (x < width - 1e-6) {
      double next = x + (half ? 0.45 : 0.9) + random.uniform(-0.06, 0.06);
      half = false;
      if (next > width - 0.3) next = width;
      double lo = x, hi = next;
      x = next;
      if (y < gap_height) {  // leaves the opening free
        const double g0 = gap.x, g1 = gap.x + gap.y;
        if (lo >= g0 && hi <= g1) continue;
        if (lo < g0 && hi > g0) hi = g0;
        if (lo < g1 && hi > g1 && lo >= g0) lo = g1;
      }
      if (hi - lo < 0.06) continue;
      const double out = random.uniform(0.02, 0.035);
      b.at({{0, y, 0}, {1, 0, 0}, {0, 0, 1}, {0, -1, 0}}, [&] {
        b.bevelled_slab({lo + joint, -0.01, -(h - joint)}, {hi - joint, out, -joint}, 0.014);
      });
    }
  }
}

}  // namespace voxdag::scenes::courtyard
