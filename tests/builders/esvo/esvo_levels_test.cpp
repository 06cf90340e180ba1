// Tests colours over the levels. The colour of a coarse voxel is the mean of the finer voxels in
// it, and the colour of the leaf of an octree that ends there. Detail finer than voxels averages
// out.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <tuple>

#include "support/temp_dir.hpp"
#include "support/test_png.hpp"
#include "voxdag/builders/esvo/build/build_esvo.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/core/srgb.hpp"
#include "voxdag/stored/esvo/stored_values.hpp"

namespace voxdag {
namespace {

constexpr int kTexels = 512;

/// Linear light of a voxel, and its weight (voxels of the finest level).
struct WeightedColor {
  Vec3f color{};
  float weight = 0;
};
using Level = std::map<std::tuple<int, int, int>, WeightedColor>;

class EsvoLevels : public testing::Test {
 protected:
  /// Makes the plane z = 0.3 of the unit cube with grey noise, which compression represents well.
  EsvoLevels() {
    mesh_.vertices = {{0, 0, 0.3f}, {1, 0, 0.3f}, {1, 1, 0.3f}, {0, 1, 0.3f}};
    mesh_.triangles = {{0, 1, 2}, {0, 2, 3}};
    appearance_.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 1}, {1, 0}, {0, 0}};
    appearance_.materials.resize(1);
    std::mt19937 random(11);
    std::vector<std::uint16_t> samples(std::size_t{kTexels} * kTexels);
    for (auto& sample : samples) sample = random() % 2 == 0 ? 0 : 255;
    const auto path = directory_.path() / "noise.png";
    write_test_png(path, kTexels, kTexels, 1, 8, samples);
    appearance_.images.push_back({path.string(), path, {}});
    appearance_.materials[0].color_map.image = 0;
  }

  Esvo build(int levels) const {
    const double voxel = std::ldexp(1.0, -levels);
    const SurfaceShading shading(mesh_, appearance_);
    EsvoOptions options;
    options.settings.contours = false;  // no leaf above the finest level
    return build_esvo(mesh_, {levels, {0, 0, 0}, voxel, kSubvoxels / voxel}, options, &shading);
  }

  static std::vector<Level> levels_of(const EsvoView& esvo) {
    std::vector<Level> levels(static_cast<std::size_t>(esvo.levels) + 1);
    const auto walk = [&](const auto& self, std::uint64_t slot, int level, Vec3i cell) -> float {
      const ChildDescriptor d = esvo.descriptor(slot);
      float sum = 0;
      for (int i = 0; i < 8; ++i) {
        if ((d.valid_mask() >> i & 1) == 0) continue;
        const Vec3i at = cell * 2 + child_offset(i);
        WeightedColor value;
        EXPECT_TRUE(stored_color(esvo, {slot, i}, value.color));
        const bool is_leaf = (d.leaf_mask() >> i & 1) != 0;
        value.weight = is_leaf ? 1 : self(self, esvo.child(slot, d, i), level + 1, at);
        sum += value.weight;
        levels[static_cast<std::size_t>(level) + 1][{at.x, at.y, at.z}] = value;
      }
      return sum;
    };
    walk(walk, esvo.root, 0, {});
    return levels;
  }

  /// Returns the root mean square of the differences between the channels of two levels with equal
  /// voxels.
  static double difference(const Level& a, const Level& b) {
    EXPECT_EQ(a.size(), b.size());
    double sum = 0;
    for (const auto& [cell, value] : a) {
      const auto other = b.find(cell);
      if (other == b.end()) return HUGE_VAL;
      const Vec3f d = value.color - other->second.color;
      sum += static_cast<double>(dot(d, d)) / 3;
    }
    return std::sqrt(sum / static_cast<double>(a.size()));
  }

  static Level average(const Level& fine) {
    Level coarse;
    for (const auto& [cell, value] : fine) {
      const auto [x, y, z] = cell;
      WeightedColor& sum = coarse[{x / 2, y / 2, z / 2}];
      sum.color = sum.color + value.color * value.weight;
      sum.weight += value.weight;
    }
    for (auto& [cell, value] : coarse) value.color = value.color * (1 / value.weight);
    return coarse;
  }

  static double spread(const Level& level) {
    double sum = 0, squares = 0;
    for (const auto& [cell, value] : level) {
      sum += static_cast<double>(value.color.x);
      squares += static_cast<double>(value.color.x * value.color.x);
    }
    const auto n = static_cast<double>(level.size());
    return std::sqrt(squares / n - sum * sum / (n * n));
  }

  TempDir directory_;
  Mesh mesh_;
  Appearance appearance_;
};

TEST_F(EsvoLevels, AreTheMeansOfTheFinerOnes) {
  const Esvo esvo = build(7);
  const std::vector<Level> levels = levels_of(esvo.view());
  // Stored colours have the error of the compression. It is smaller at levels whose voxels are more
  // similar.
  for (std::size_t level = 2; level < 7; ++level)
    EXPECT_LT(difference(levels[level], average(levels[level + 1])), 0.02) << level;
}

TEST_F(EsvoLevels, LookLikeAnOctreeThatEndsThere) {
  const Esvo fine = build(7);
  const std::vector<Level> levels = levels_of(fine.view());
  for (const int coarsest : {4, 5, 6}) {
    const Esvo coarse = build(coarsest);
    const auto at = static_cast<std::size_t>(coarsest);
    EXPECT_LT(difference(levels_of(coarse.view())[at], levels[at]), 0.03) << coarsest;
  }
}

TEST_F(EsvoLevels, DetailFinerThanVoxelsAveragesOut) {
  // Texels are 0 or 1: the mean over n x n of them spreads by 1/2n.
  for (const int finest : {5, 6, 7}) {
    const Esvo esvo = build(finest);
    const double texels = kTexels / std::ldexp(1.0, finest);
    const Level level = levels_of(esvo.view())[static_cast<std::size_t>(finest)];
    EXPECT_LT(spread(level), 1.3 * 0.5 / texels) << finest;
  }
}

}  // namespace
}  // namespace voxdag
