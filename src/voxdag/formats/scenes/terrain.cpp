#include <algorithm>
#include <cmath>

#include "voxdag/formats/scenes/builder.hpp"
#include "voxdag/formats/scenes/list.hpp"
#include "voxdag/formats/scenes/random.hpp"
#include "voxdag/formats/scenes/terrain_height.hpp"

/// Two kilometres of eroded mountains above a lake, cut out of the earth as a block, with rocks and
/// firs. The block, each rock and each tree is closed; the lake is a sheet over it.
namespace voxdag::scenes {
namespace {

constexpr double kSide = 2000, kBottom = -140, kLake = 4;

/// Returns the number of rocks or trees of a field: `count` from 512 cells a side on, else fewer.
int things(const HeightField& field, int count) {
  const double part = std::min(1.0, field.cells / 512.0);
  return static_cast<int>(count * part * part);
}

void block(Builder& b, const HeightField& field) {
  const int n = field.cells;
  const double c = field.cell();
  b.material("ground");
  b.surface(n, n, false, false, [&](int i, int j) { return Vec3d{j * c, field.at(j, i), i * c}; });
  b.material("earth");
  b.surface(n, 1, false, false, [&](int i, int j) {
    return Vec3d{i * c, j == 0 ? kBottom : field.at(i, n), kSide};
  });
  b.surface(n, 1, false, false, [&](int i, int j) {
    return Vec3d{i * c, j == 1 ? kBottom : field.at(i, 0), 0};
  });
  b.surface(n, 1, false, false, [&](int i, int j) {
    return Vec3d{0, j == 0 ? kBottom : field.at(0, i), i * c};
  });
  b.surface(n, 1, false, false, [&](int i, int j) {
    return Vec3d{kSide, j == 1 ? kBottom : field.at(n, i), i * c};
  });
  b.quad({0, kBottom, 0}, {kSide, kBottom, 0}, {kSide, kBottom, kSide}, {0, kBottom, kSide});
}

/// Draws the sheet of water, with walls down to the ground at the edge of the block.
void lake(Builder& b, const HeightField& field, std::uint32_t seed) {
  b.material("water");
  const int n = std::min(400, field.cells);
  b.surface(n, n, false, false, [&](int i, int j) {
    const double x = kSide * j / n, z = kSide * i / n;
    const double inside = std::min(std::min(x, kSide - x), std::min(z, kSide - z));
    const double wave = 0.4 * noise({x / 22, 0.5, z / 12}, seed + 7);
    return Vec3d{x, kLake + wave * clamp01(inside / 40), z};
  });
  const auto side = [&](double x0, double z0, double x1, double z1) {
    b.surface(n, 1, false, false, [&](int i, int j) {
      const double t = static_cast<double>(i) / n, x = lerp(x0, x1, t), z = lerp(z0, z1, t);
      return Vec3d{x, j == 0 ? std::min(kLake, field.height(x, z)) : kLake, z};
    });
  };
  side(0, kSide, kSide, kSide);
  side(kSide, kSide, kSide, 0);
  side(kSide, 0, 0, 0);
  side(0, 0, 0, kSide);
}

/// Returns v^6, which is small for most of [0,1]. std::pow may round differently on other machines.
double sixth_power(double v) { return v * v * v * v * v * v; }

void rocks(Builder& b, const HeightField& field, std::uint32_t seed) {
  Random random(seed, 21);
  b.material("rock");
  for (int i = 0; i < things(field, 3000); ++i) {
    const double x = random.uniform(12, kSide - 12), z = random.uniform(12, kSide - 12);
    const double size = 0.8 + 5.5 * sixth_power(random.uniform()), slope = field.slope(x, z);
    const double turns = random.uniform();
    const Vec3d squash{random.uniform(0.8, 1.3), random.uniform(0.55, 0.9),
                       random.uniform(0.8, 1.3)};
    const std::uint32_t shape = random.next();
    if (slope > 0.9 || slope < 0.12) continue;
    b.at(placed({x, field.height(x, z) + 0.15 * size, z}, turns), [&] {
      b.ball(size > 3 ? 10 : 5, [&](Vec3d d) {
        // A rock is a ball that is cut by a few planes, with noise.
        double r = 1 + 0.25 * noise(d * 1.3, shape);
        for (int k = 0; k < 5; ++k) {
          const Vec3d n =
              normalized(Vec3d{noise({k + 0.5, 0.3, 0.7}, shape), noise({k + 0.5, 5.3, 0.7}, shape),
                               noise({k + 0.5, 9.3, 0.7}, shape)});
          const double facing = dot(d, n);
          if (facing > 0.2) r = std::min(r, 0.72 / facing);
        }
        const double stretch = 1 / length(Vec3d{d.x / squash.x, d.y / squash.y, d.z / squash.z});
        return size * r * stretch * (1 + 0.06 * noise(d * 6.0, shape + 1));
      });
    });
  }
}

/// Draws a trunk and skirts of branches, each a ragged cone.
void fir(Builder& b, Random& random, double height) {
  b.material("bark");
  b.lathe({{0, -1}, {0.035 * height, -1}, {0.02 * height, 0.3 * height}, {0, 0.3 * height}}, 6);
  b.material("needles");
  const int skirts = 5, sides = 10;
  const std::uint32_t shape = random.next();
  for (int s = 0; s < skirts; ++s) {
    const double lo = lerp(0.12, 0.72, s / (skirts - 1.0)), hi = std::min(1.0, lo + 0.36);
    const double r = 0.21 * (1 - lo) * height;
    b.carved_lathe(
        {{0, (lo + 0.05) * height}, {r, lo * height}, {0, hi * height}}, sides,
        [&](double t, int) {
          return 1 + 0.35 * noise({t * sides * 0.9, s + 0.5, 0.2}, shape);
        },
        random.uniform());
  }
}

void trees(Builder& b, const HeightField& field, std::uint32_t seed) {
  Random random(seed, 22);
  for (int i = 0; i < things(field, 24000); ++i) {
    const double x = random.uniform(8, kSide - 8), z = random.uniform(8, kSide - 8);
    const double y = field.height(x, z), turns = random.uniform(), height = random.uniform(9, 19);
    const double woods =
        noise({x / 210, 0.5, z / 210}, seed + 8) + 0.5 * noise({x / 60, 0.5, z / 60}, seed + 9);
    if (y < kLake + 2.5 || y > 190 + 50 * woods || field.slope(x, z) > 0.62 || woods < -0.1)
      continue;
    b.at(placed({x, y, z}, turns), [&] { fir(b, random, height); });
  }
}

}  // namespace

Mesh make_terrain(double size, std::uint32_t seed, Work work) {
  const HeightField field = mountain_heights(static_cast<int>(size), kSide, seed);
  Builder b(work);
  b.frame({{-kSide / 2, 0, -kSide / 2}});
  block(b, field);
  lake(b, field, seed);
  rocks(b, field, seed);
  trees(b, field, seed);
  return b.take();
}

ScenePreset terrain_preset(double) {
  ScenePreset preset;
  preset.eye = {-120, 150, 1010};
  preset.target = {20, 105, 0};
  preset.fov_degrees = 48;
  preset.sun_direction = normalized(Vec3d{-0.8, 0.42, 0.3});
  preset.flight = {{0, preset.eye, preset.target},           {4, {-160, 120, 640}, {20, 100, 0}},
                   {8, {-100, 190, 300}, {60, 120, -200}},   {12, {40, 330, -20}, {200, 170, -400}},
                   {16, {260, 450, -250}, {200, 220, -700}}, {20, {520, 500, -420}, {0, 150, -600}},
                   {24, {620, 430, 100}, {0, 150, 0}},       {28, {420, 420, 760}, {0, 120, 0}}};
  return preset;
}

}  // namespace voxdag::scenes
