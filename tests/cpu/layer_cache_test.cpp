#include "voxdag/cpu/layer_cache.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "support/brute_svdag.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {
namespace {

/// Cells of three levels of a sphere in any order, several times as many as the cache holds.
TEST(LayerCache, ChangesNothing) {
  constexpr int kLevels = 6;
  std::vector<Vec3i> voxels;
  for (std::uint64_t code = 0; code < 1u << (3 * kLevels); ++code) {
    const Vec3i v = morton_decode(code), d = v - Vec3i{32, 31, 33};
    if (dot(d, d) > 24 * 24 && dot(d, d) < 25 * 25) voxels.push_back(v);
  }
  const Svdag dag = brute_svdag(kLevels, voxels);
  const SvdagNodes nodes(dag.view());
  FreshLayers fresh_layers;
  LayerCache kept_layers;
  std::mt19937 random(3);
  const auto number = [&random] { return static_cast<float>(random() % 2001) / 1000 - 1.0f; };
  for (int i = 0; i < 40'000; ++i) {
    // Half of the cells come from a part of the sphere, so that some of them come again soon.
    const Vec3i voxel = voxels[random() % (i % 2 == 0 ? voxels.size() : 300)];
    const int up = static_cast<int>(random() % 3);
    const Vec3i cell{voxel.x >> up, voxel.y >> up, voxel.z >> up};
    const Vec3f view = normalized(Vec3f{number(), number(), number() + 3});
    const Vec3f face{0, i % 3 == 0 ? 1.0f : -1.0f, 0};
    const SmoothSurface fresh = smooth_surface(nodes, kLevels - up, cell, view, face, fresh_layers);
    const SmoothSurface kept = smooth_surface(nodes, kLevels - up, cell, view, face, kept_layers);
    ASSERT_EQ(kept.normal, fresh.normal);
    ASSERT_EQ(kept.height, fresh.height);
    ASSERT_EQ(kept.is_flat, fresh.is_flat);
  }
}

}  // namespace
}  // namespace voxdag
