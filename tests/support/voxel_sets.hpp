#pragma once
/// Makes voxel sets that are hard for a traversal in different ways.
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "voxdag/core/vec.hpp"

namespace voxdag {

struct NamedVoxels {
  std::string name;
  std::vector<Vec3i> voxels;
};

/// Returns all voxels of a grid of 2^levels for which keep(v) is true.
template <class Keep>
std::vector<Vec3i> voxels_where(int levels, const Keep& keep) {
  std::vector<Vec3i> voxels;
  const std::int32_t n = 1 << levels;
  for (std::int32_t z = 0; z < n; ++z)
    for (std::int32_t y = 0; y < n; ++y)
      for (std::int32_t x = 0; x < n; ++x)
        if (keep(Vec3i{x, y, z})) voxels.push_back({x, y, z});
  return voxels;
}

/// Returns empty, single, planar, curved, random, periodic and full sets.
inline std::vector<NamedVoxels> voxel_sets(int levels, unsigned seed) {
  const std::int32_t n = 1 << levels;
  std::mt19937 rng(seed);
  const auto one_in = [&](unsigned m) { return [&rng, m](Vec3i) { return rng() % m == 0; }; };
  const auto any = [&] { return static_cast<std::int32_t>(rng() % static_cast<unsigned>(n)); };
  const double centre = n / 2.0, radius = n * 0.45;
  const auto is_shell = [&](Vec3i v) {
    const double x = v.x + 0.5 - centre, y = v.y + 0.5 - centre, z = v.z + 0.5 - centre;
    return std::fabs(std::sqrt(x * x + y * y + z * z) - radius) < 0.9;
  };
  const auto is_slanted = [&](Vec3i v) { return (v.x + 2 * v.y + v.z) / 4 == n / 2; };
  return {{"empty", {}},
          {"one voxel", {{any(), any(), any()}}},
          {"corners", {{0, 0, 0}, {n - 1, n - 1, n - 1}, {0, n - 1, 0}, {n - 1, 0, n - 1}}},
          {"one in 1000", voxels_where(levels, one_in(1000))},
          {"one in 30", voxels_where(levels, one_in(30))},
          {"one in 2", voxels_where(levels, one_in(2))},
          {"plane", voxels_where(levels, [&](Vec3i v) { return v.z == n / 2; })},
          {"slanted", voxels_where(levels, is_slanted)},
          {"shell", voxels_where(levels, is_shell)},
          {"checkers", voxels_where(levels, [](Vec3i v) { return ((v.x ^ v.y ^ v.z) & 1) != 0; })},
          {"rods", voxels_where(levels, [](Vec3i v) { return v.x % 4 == 1 && v.y % 4 == 2; })},
          {"full", voxels_where(levels, [](Vec3i) { return true; })}};
}

}  // namespace voxdag
