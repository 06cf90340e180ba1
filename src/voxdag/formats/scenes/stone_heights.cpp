#include "voxdag/formats/scenes/stone_heights.hpp"

#include <algorithm>
#include <cmath>

namespace voxdag {
namespace {

constexpr int kCourses = 8;

/// Returns a hash, evenly distributed in [0,1).
double random(std::uint32_t seed, int x, int y) {
  std::uint32_t h = seed * 0x9E3779B9u;
  for (const int key : {x, y}) {
    h = (h ^ static_cast<std::uint32_t>(key)) * 0x85EBCA6Bu;
    h = (h ^ h >> 13) * 0xC2B2AE35u;
    h ^= h >> 16;
  }
  return h / 4294967296.0;
}

double smooth(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Returns smooth noise in [0,1) of period `cells` over the unit square.
double noise(std::uint32_t seed, double u, double v, int cells) {
  const double x = u * cells, y = v * cells;
  const int ix = static_cast<int>(std::floor(x)), iy = static_cast<int>(std::floor(y));
  const double wx = smooth(x - ix), wy = smooth(y - iy);
  const auto at = [&](int i, int j) {
    return random(seed, (i % cells + cells) % cells, (j % cells + cells) % cells);
  };
  const double top = at(ix, iy) * (1 - wx) + at(ix + 1, iy) * wx;
  const double bottom = at(ix, iy + 1) * (1 - wx) + at(ix + 1, iy + 1) * wx;
  return top * (1 - wy) + bottom * wy;
}

/// Returns noise of several frequencies, with a mean of about 0.
double roughness(std::uint32_t seed, double u, double v) {
  double sum = 0, weight = 0.5;
  for (int cells = 16; cells <= 128; cells *= 2, weight *= 0.55)
    sum += weight * (noise(seed + static_cast<std::uint32_t>(cells), u, v, cells) - 0.5);
  return sum;
}

double stone_height(std::uint32_t seed, double u, double v) {
  // Uneven joints.
  const double wu = u + 0.008 * (noise(seed + 1, u, v, 24) - 0.5);
  const double wv = v + 0.008 * (noise(seed + 2, u, v, 24) - 0.5);
  const double y = (wv - std::floor(wv)) * kCourses;
  const int course = static_cast<int>(y) % kCourses;
  const int blocks = 3 + static_cast<int>(random(seed + 3, course, 0) * 3);
  const double x = wu * blocks + random(seed + 4, course, 0);
  const double cell = std::floor(x);
  // The joint before block k deviates a little from even spacing.
  const auto joint = [&](double k) {
    const int block = (static_cast<int>(k) % blocks + blocks) % blocks;
    return k + 0.35 * (random(seed + 5, block, course) - 0.5);
  };
  const double first = x < joint(cell) ? cell - 1 : x >= joint(cell + 1) ? cell + 1 : cell;
  const int block = (static_cast<int>(first) % blocks + blocks) % blocks;
  const double to_side = std::min(x - joint(first), joint(first + 1) - x) / blocks;
  const double in_course = y - std::floor(y);
  const double to_edge = std::min(to_side, std::min(in_course, 1 - in_course) / kCourses);
  const double top = 0.7 + 0.25 * random(seed + 6, block, course);
  const double body = top + 0.18 * roughness(seed + 7, u, v);
  const double mortar = 0.18 + 0.1 * roughness(seed + 8, u, v);
  return std::clamp(mortar + (body - mortar) * smooth((to_edge - 0.004) / 0.014), 0.1, 1.0);
}

}  // namespace

HeightTexture make_stone_heights(std::uint32_t seed, int size) {
  HeightTexture::Texels texels;
  texels.reserve(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      texels.push_back({static_cast<std::uint16_t>(
          65535 * stone_height(seed, (x + 0.5) / size, (y + 0.5) / size))});
  return HeightTexture(size, size, std::move(texels));
}

}  // namespace voxdag
