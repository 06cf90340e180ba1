#include "voxdag/formats/scenes/random.hpp"

#include <initializer_list>

namespace voxdag::scenes {
namespace {

std::uint32_t hash(std::int64_t x, std::int64_t y, std::int64_t z, std::uint32_t seed) {
  std::uint64_t h = seed + 0x9E3779B97F4A7C15ull;
  for (const std::int64_t v : {x, y, z}) {
    h = (h ^ static_cast<std::uint64_t>(v)) * 0xBF58476D1CE4E5B9ull;
    h ^= h >> 29;
  }
  return static_cast<std::uint32_t>((h * 0x94D049BB133111EBull) >> 32);
}

/// Returns the dot product with one of the twelve edge directions of a cube.
double gradient(std::uint32_t h, double x, double y, double z) {
  const std::uint32_t g = h & 15;
  const double u = g < 8 ? x : y, v = g < 4 ? y : g == 12 || g == 14 ? x : z;
  return ((g & 1) != 0 ? -u : u) + ((g & 2) != 0 ? -v : v);
}

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

}  // namespace

double noise(Vec3d p, std::uint32_t seed) {
  const double fx = std::floor(p.x), fy = std::floor(p.y), fz = std::floor(p.z);
  const auto x = static_cast<std::int64_t>(fx), y = static_cast<std::int64_t>(fy),
             z = static_cast<std::int64_t>(fz);
  const double u = p.x - fx, v = p.y - fy, w = p.z - fz;
  const auto corner = [&](int i, int j, int k) {
    return gradient(hash(x + i, y + j, z + k, seed), u - i, v - j, w - k);
  };
  const double a = fade(u), b = fade(v), c = fade(w);
  const double low =
      lerp(lerp(corner(0, 0, 0), corner(1, 0, 0), a), lerp(corner(0, 1, 0), corner(1, 1, 0), a), b);
  const double high =
      lerp(lerp(corner(0, 0, 1), corner(1, 0, 1), a), lerp(corner(0, 1, 1), corner(1, 1, 1), a), b);
  return lerp(low, high, c);
}

double fractal_noise(Vec3d p, std::uint32_t seed, int octaves, double gain) {
  double sum = 0, height = 1;
  for (int i = 0; i < octaves; ++i) {
    sum += height * noise(p, seed + static_cast<std::uint32_t>(i));
    height *= gain;
    p = p * 2.0;
  }
  return sum;
}

}  // namespace voxdag::scenes
