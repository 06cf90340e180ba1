#include <algorithm>
#include <cmath>

#include "voxdag/formats/scenes/city_parts.hpp"
#include "voxdag/formats/scenes/list.hpp"

/// A town of square blocks: shops and houses at the edge, towers in the middle, some parks, streets
/// with trees, lamps and cars. The centre of the town is the origin; the street is y = 0.
namespace voxdag::scenes {
namespace {

using namespace city;

constexpr double kBlockX = 76, kBlockZ = 60, kStreet = 16, kSidewalk = 3.6, kKerb = 0.16;
constexpr double kPitchX = kBlockX + kStreet, kPitchZ = kBlockZ + kStreet;

/// Divides a rectangle into lots and draws a building on each.
void lots(Builder& b, Random& random, double x0, double x1, double z0, double z1,
          double centrality) {
  const double w = x1 - x0, d = z1 - z0, limit = lerp(21, 34, centrality);
  if (std::max(w, d) > limit) {
    const double cut = random.uniform(0.4, 0.6);
    if (w > d) {
      lots(b, random, x0, x0 + w * cut, z0, z1, centrality);
      lots(b, random, x0 + w * cut, x1, z0, z1, centrality);
    } else {
      lots(b, random, x0, x1, z0, z0 + d * cut, centrality);
      lots(b, random, x0, x1, z0 + d * cut, z1, centrality);
    }
    return;
  }
  const double gap = random.chance(0.4) ? 0.02 : random.uniform(0.6, 1.8);
  building(b, random, x0 + gap, x1 - gap, z0 + gap, z1 - gap, centrality);
}

/// Draws trees and lamps along the four sides of a block whose half extents are hx and hz.
void kerbside(Builder& b, Random& random, double hx, double hz) {
  for (int side = 0; side < 4; ++side) {
    const double half = side % 2 == 0 ? hx : hz, out = side % 2 == 0 ? hz : hx;
    b.at(placed({}, 0.25 * side), [&] {
      int i = 0;
      for (double x = -half + 6; x < half - 5; x += 9.3, ++i) {
        if (i % 3 == 1) {
          b.at({{x, kKerb, out - 0.6}}, [&] { street_lamp(b); });
          continue;
        }
        if (random.chance(0.18)) continue;
        b.at(placed({x, kKerb, out - 1.1}, random.uniform()),
             [&] { tree(b, random, random.uniform(5, 8.5)); });
        b.material("metal");
        b.at({{x, kKerb, out - 1.1}}, [&] {
          b.square({{0.75, 0}, {0.75, 0.05}, {0.65, 0.05}, {0.65, 0}});
        });
      }
      for (double x = -half + 7; x < half - 6; x += 6.1)
        if (random.chance(0.55))
          b.at(placed({x + random.uniform(-0.4, 0.4), 0, out + 1.35}, 0), [&] { car(b, random); });
    });
  }
}

void block(Builder& b, std::uint32_t seed, int i, int k, int blocks) {
  Random random(seed, static_cast<std::uint64_t>(k) * 1000 + static_cast<std::uint64_t>(i) + 100);
  const double cx = (i - (blocks - 1) / 2.0) * kPitchX, cz = (k - (blocks - 1) / 2.0) * kPitchZ;
  const double reach = std::max(blocks, 2) * 0.62, u = cx / kPitchX / reach,
               v = cz / kPitchZ / reach;
  const double centrality = clamp01(1.08 - 1.5 * std::sqrt(u * u + v * v));
  b.at({{cx, 0, cz}}, [&] {
    const double hx = kBlockX / 2, hz = kBlockZ / 2;
    b.material("pavement");
    b.bevelled_slab({-hx, -0.1, -hz}, {hx, kKerb, hz}, 0.05);
    kerbside(b, random, hx, hz);
    const double ix = hx - kSidewalk, iz = hz - kSidewalk;
    b.at({{0, kKerb, 0}}, [&] {
      if (random.chance(0.09)) {
        park(b, random, ix, iz);
      } else {
        lots(b, random, -ix, ix, -iz, iz, centrality);
      }
    });
  });
}

/// Draws asphalt, lane marks, zebra crossings and moving cars.
void streets(Builder& b, std::uint32_t seed, int blocks) {
  Random random(seed, 1);
  const double hx = blocks * kPitchX / 2 + kStreet / 2, hz = blocks * kPitchZ / 2 + kStreet / 2;
  b.material("asphalt");
  b.box({-hx, -0.6, -hz}, {hx, 0, hz});
  const auto mark = [&](double x, double z, double half_x, double half_z) {
    b.material("marking");
    b.bevelled_slab({x - half_x, -0.01, z - half_z}, {x + half_x, 0.012, z + half_z}, 0.004);
  };
  for (int axis = 0; axis < 2; ++axis)
    b.at(placed({}, 0.25 * axis), [&] {
      // In this frame the streets run along x. In the turned frame the two pitches are exchanged.
      const double along = axis == 0 ? kPitchX : kPitchZ, across = axis == 0 ? kPitchZ : kPitchX;
      for (int line = 0; line <= blocks; ++line) {
        const double z = (line - blocks / 2.0) * across;
        for (int i = 0; i < blocks; ++i) {
          const double x = (i - (blocks - 1) / 2.0) * along, half = (along - kStreet) / 2;
          for (double s = -half + 7; s < half - 5; s += 6) mark(x + s, z, 1.4, 0.08);
          for (const double end : {-half + 2.5, half - 2.5})
            for (double s = -kStreet / 2 + 1; s < kStreet / 2 - 0.5; s += 1.1)
              mark(x + end, z + s, 1.3, 0.28);
          for (const double lane : {-2.6, 2.6})
            if (random.chance(0.75))
              b.at(placed({x + random.uniform(-half + 6, half - 6), 0, z + lane},
                          lane > 0 ? 0 : 0.5),
                   [&] { car(b, random); });
        }
      }
    });
}

}  // namespace

Mesh make_city(double size, std::uint32_t seed, Work work) {
  const int blocks = static_cast<int>(size);
  Builder b(work);
  streets(b, seed, blocks);
  for (int k = 0; k < blocks; ++k)
    for (int i = 0; i < blocks; ++i) block(b, seed, i, k, blocks);
  return b.take();
}

ScenePreset city_preset(double size) {
  const double blocks = std::max(1.0, std::floor(size));
  ScenePreset preset;
  preset.eye = {0.3 * blocks * kPitchX, 40 + 11 * blocks, 0.56 * blocks * kPitchZ};
  preset.target = {0, 8 + 3 * blocks, 0};
  preset.fov_degrees = 50;
  preset.sun_direction = normalized(Vec3d{-0.72, 0.55, 0.42});
  // The flight goes down into the street nearest to the middle, around a corner, and up again.
  const bool is_even = std::fmod(blocks, 2) == 0;
  const double x = is_even ? 0 : kPitchX / 2, z = is_even ? 0 : kPitchZ / 2;
  const double far_x = blocks * kPitchX / 2, far_z = blocks * kPitchZ / 2;
  preset.flight = {{0, preset.eye, preset.target},
                   {4, {x + 30, 24 + 7 * blocks, far_z + 50}, {x, 14, 0}},
                   {8, {x, 15, far_z * 0.8}, {x, 10, -far_z * 0.2}},
                   {12, {x, 7, z + 0.2 * far_z}, {x + 6, 8, z - 20}},
                   {14, {x + 5, 6.5, z + 4}, {x + 40, 9, z}},
                   {17, {x + 0.4 * kPitchX, 7, z}, {x + 1.4 * kPitchX, 9, z}},
                   {20, {x + kPitchX, 12, z}, {x + 1.7 * kPitchX, 30, z}},
                   {24, {x + kPitchX, 40 + 6 * blocks, z}, {x, 14, z - kPitchZ}},
                   {29, {far_x + 60, 30 + 8 * blocks, -0.5 * far_z}, {0, 10, 0}}};
  return preset;
}

}  // namespace voxdag::scenes
