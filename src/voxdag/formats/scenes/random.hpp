#pragma once
/// Random numbers and noise that are equal on every machine.
#include <cstdint>

#include "voxdag/formats/scenes/math.hpp"

namespace voxdag::scenes {

/// PCG32. Source: O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically Good
/// Algorithms for Random Number Generation", 2014 (XSH-RR 64/32).
class Random {
 public:
  /// Streams of one seed are independent: drawing numbers from one stream does not change another.
  explicit Random(std::uint32_t seed, std::uint64_t stream = 0) : increment_(stream * 2 + 1) {
    next();
    state_ += seed;
    next();
  }
  std::uint32_t next() {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005ull + increment_;
    const auto shifted = static_cast<std::uint32_t>(((old >> 18) ^ old) >> 27);
    const auto rotation = static_cast<std::uint32_t>(old >> 59);
    return shifted >> rotation | shifted << ((32 - rotation) & 31);
  }
  /// Returns a number in [0, 1).
  double uniform() { return next() * (1.0 / 4294967296.0); }
  double uniform(double lo, double hi) { return lo + (hi - lo) * uniform(); }
  /// Returns an integer in [0, n).
  int below(int n) { return static_cast<int>(uniform() * n); }
  bool chance(double probability) { return uniform() < probability; }
  /// Returns a unit vector, uniform on the sphere.
  Vec3d direction() {
    for (;;) {
      const Vec3d v{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
      const double d = dot(v, v);
      if (d > 0.01 && d <= 1) return v * (1 / std::sqrt(d));
    }
  }

 private:
  std::uint64_t state_ = 0, increment_;
};

/// Returns smooth gradient noise in about [-1, 1], with one feature per unit.
/// Source: Perlin, "Improving Noise", SIGGRAPH 2002, with hashed lattice gradients.
double noise(Vec3d p, std::uint32_t seed);

/// Returns the sum of `octaves` noises. Each has twice the frequency of the previous one and `gain`
/// times its height.
double fractal_noise(Vec3d p, std::uint32_t seed, int octaves, double gain = 0.5);

}  // namespace voxdag::scenes
