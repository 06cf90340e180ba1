#include "voxdag/formats/scenes/terrain_height.hpp"

#include <algorithm>
#include <cmath>

#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/formats/scenes/random.hpp"

namespace voxdag::scenes {
namespace {

/// Returns the ridged multifractal. Noise folded at zero gives crests; each octave is stronger
/// where the previous one was high. Source: Musgrave, "Procedural Fractal Terrains", in "Texturing
/// and Modeling", 1994.
double ridged(Vec3d p, std::uint32_t seed, int octaves) {
  double sum = 0, height = 0.5, weight = 1;
  for (int i = 0; i < octaves; ++i) {
    double crest = 1 - std::abs(noise(p, seed + static_cast<std::uint32_t>(i)));
    crest *= crest * weight;
    weight = clamp01(crest * 2);
    sum += crest * height;
    height *= 0.5;
    p = p * 2.03;
  }
  return sum;
}

double raw_height(double u, double v, std::uint32_t seed) {
  const Vec3d p{u, 0.37, v};
  const Vec3d bend{noise(p * 1.7, seed + 100), 0, noise(p * 1.7 + Vec3d{5.2, 0, 1.3}, seed + 101)};
  const Vec3d q = p + bend * 0.16;
  // A high range at the far side falls to a basin in front.
  const double basin = noise(p * 1.1 + Vec3d{0.3, 0, 0.8}, seed + 102);
  const double range = smoothstep(1.12, 0.15, v + 0.3 * basin);
  const double hills = 0.10 + 0.06 * fractal_noise(q * 4.0, seed + 103, 5);
  return 470 * (range * ridged(q * 2.3, seed + 104, 9) + hills * (0.4 + range)) - 60 * (1 - range);
}

/// Erodes a height field by drops of water. A drop runs down the gradient with some inertia, takes
/// up soil where it is fast, and deposits soil where it is slow. Source: Beyer, "Implementation of
/// a Method for Hydraulic Erosion", 2015.
class Erosion {
 public:
  Erosion(HeightField& field, std::uint32_t seed) : field_(field), random_(seed, 9) {
    for (int dz = -kRadius; dz <= kRadius; ++dz)
      for (int dx = -kRadius; dx <= kRadius; ++dx) {
        const double weight = kRadius + 1 - std::sqrt(static_cast<double>(dx * dx + dz * dz));
        if (weight > 0) brush_.push_back({dx, dz, weight});
      }
    double sum = 0;
    for (const Dab& dab : brush_) sum += dab.weight;
    for (Dab& dab : brush_) dab.weight /= sum;
  }

  void drop() {
    const int n = field_.cells;
    // Heights are in cells, so that erosion looks similar at every resolution.
    const double unit = field_.cell();
    double x = random_.uniform(0, n), z = random_.uniform(0, n), dir_x = 0, dir_z = 0;
    double speed = 1, water = 1, soil = 0;
    for (int step = 0; step < 48; ++step) {
      const int ix = static_cast<int>(x), iz = static_cast<int>(z);
      if (ix < 0 || iz < 0 || ix >= n || iz >= n) return;
      const double u = x - ix, v = z - iz;
      const double a = field_.at(ix, iz), b = field_.at(ix + 1, iz), c = field_.at(ix, iz + 1),
                   d = field_.at(ix + 1, iz + 1);
      const double slope_x = lerp(b - a, d - c, v) / unit, slope_z = lerp(c - a, d - b, u) / unit;
      dir_x = lerp(-slope_x, dir_x, 0.08);
      dir_z = lerp(-slope_z, dir_z, 0.08);
      const double norm = std::sqrt(dir_x * dir_x + dir_z * dir_z);
      if (norm < 1e-9) return;
      dir_x /= norm;
      dir_z /= norm;
      const double before = lerp(lerp(a, b, u), lerp(c, d, u), v);
      x += dir_x;
      z += dir_z;
      if (x < 0 || z < 0 || x >= n || z >= n) return;
      const double fall = (before - field_.height(x * unit, z * unit)) / unit;

      const double capacity = std::max(fall, 0.01) * speed * water * 4;
      if (soil > capacity || fall < 0) {
        const double left = fall < 0 ? std::min(-fall, soil) : (soil - capacity) * 0.3;
        soil -= left;
        const double w[4] = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
        for (int i = 0; i < 4; ++i) field_.at(ix + (i & 1), iz + (i >> 1)) += left * unit * w[i];
      } else {
        const double taken = std::min((capacity - soil) * 0.3, fall);
        soil += taken;
        for (const Dab& dab : brush_) {
          const int bx = ix + dab.dx, bz = iz + dab.dz;
          if (bx >= 0 && bz >= 0 && bx <= n && bz <= n)
            field_.at(bx, bz) -= taken * unit * dab.weight;
        }
      }
      speed = std::sqrt(std::max(0.0, speed * speed + fall * 4));
      water *= 0.98;
    }
  }

 private:
  static constexpr int kRadius = 2;
  struct Dab {
    int dx, dz;
    double weight;
  };
  HeightField& field_;
  Random random_;
  std::vector<Dab> brush_;
};

/// Applies a binomial filter of 3 by 3, because drops leave pits of single cells.
void soften(HeightField& field) {
  const HeightField old = field;
  const int n = field.cells;
  for (int z = 0; z <= n; ++z)
    for (int x = 0; x <= n; ++x) {
      double sum = 0;
      for (int dz = -1; dz <= 1; ++dz)
        for (int dx = -1; dx <= 1; ++dx)
          sum += old.at(std::clamp(x + dx, 0, n), std::clamp(z + dz, 0, n)) *
                 ((2 - dx * dx) * (2 - dz * dz));
      field.at(x, z) = sum / 16;
    }
}

}  // namespace

double HeightField::height(double x, double z) const {
  const double gx = std::clamp(x / cell(), 0.0, cells - 1e-9),
               gz = std::clamp(z / cell(), 0.0, cells - 1e-9);
  const int ix = static_cast<int>(gx), iz = static_cast<int>(gz);
  return lerp(lerp(at(ix, iz), at(ix + 1, iz), gx - ix),
              lerp(at(ix, iz + 1), at(ix + 1, iz + 1), gx - ix), gz - iz);
}

double HeightField::slope(double x, double z) const {
  const double d = cell() * 2;
  const double dx = (height(x + d, z) - height(x - d, z)) / (2 * d),
               dz = (height(x, z + d) - height(x, z - d)) / (2 * d);
  return std::sqrt(dx * dx + dz * dz);
}

HeightField mountain_heights(int cells, double side, std::uint32_t seed) {
  HeightField field{cells, side, {}};
  const auto rows = static_cast<std::size_t>(cells) + 1;
  field.heights.resize(rows * rows);
  parallel_for(rows, [&](std::size_t row) {
    const int z = static_cast<int>(row);
    for (int x = 0; x <= cells; ++x)
      field.at(x, z) =
          raw_height(static_cast<double>(x) / cells, static_cast<double>(z) / cells, seed);
  });
  Erosion erosion(field, seed);
  const std::int64_t drops = static_cast<std::int64_t>(cells) * cells / 5;
  for (std::int64_t i = 0; i < drops; ++i) erosion.drop();
  soften(field);
  return field;
}

}  // namespace voxdag::scenes
