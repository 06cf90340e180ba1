// Tests the special cases in the definition of a hit, one fact each.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/brute_svdag.hpp"
#include "support/test_rays.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A grid of 8³ voxels of size 1 at the origin, with the given voxels set.
class Scene {
 public:
  explicit Scene(const std::vector<Vec3i>& voxels) : dag_(brute_svdag(3, voxels)) {
    grid_.levels = 3;
  }
  Hit cast(Vec3f origin, Vec3f direction, float t_min = 0, float t_max = kInfinity) const {
    return closest_hit(SvdagNodes(dag_.view()), grid_, {origin, t_min, direction, t_max});
  }

 private:
  Svdag dag_;
  Grid grid_;
};

TEST(CastRules, TheEnteredFaceIsNamedByItsOutwardNormal) {
  const Scene scene({{4, 4, 4}});
  const Vec3f centre{4.5f, 4.5f, 4.5f};
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f}) {
      Vec3f normal{};
      normal[axis] = side;
      const Hit hit = scene.cast(centre + normal * 3.0f, -normal);
      EXPECT_TRUE(hit.hit);
      EXPECT_EQ(hit.voxel, (Vec3i{4, 4, 4}));
      EXPECT_EQ(hit.t, 2.5f);
      EXPECT_EQ(face_normal(hit.face), static_cast<Vec3i>(normal));
      EXPECT_EQ(hit.level, 3);
    }
}

TEST(CastRules, TIsInUnitsOfTheDirection) {
  const Scene scene({{4, 4, 4}});
  EXPECT_EQ(scene.cast({0.5f, 4.5f, 4.5f}, {0.25f, 0, 0}).t, 14.0f);
  EXPECT_EQ(scene.cast({-7.5f, 4.5f, 4.5f}, {2, 0, 0}).t, 5.75f);
}

TEST(CastRules, ARayThatStartsInsideHitsAtTMinWithoutAFace) {
  const Scene scene({{4, 4, 4}});
  const Hit hit = scene.cast({4.5f, 4.25f, 4.5f}, {1, 0.5f, 0});
  EXPECT_TRUE(hit.hit);
  EXPECT_EQ(hit.t, 0.0f);
  EXPECT_EQ(hit.face, Face::kNone);
  const Hit later = scene.cast({2.5f, 4.5f, 4.5f}, {1, 0, 0}, 2);
  EXPECT_TRUE(later.hit);
  EXPECT_EQ(later.t, 2.0f);
  EXPECT_EQ(later.face, Face::kNone);
}

TEST(CastRules, ARayThatStartsOnAFaceIsInTheVoxelAhead) {
  const Scene scene({{4, 4, 4}});
  EXPECT_EQ(scene.cast({4, 4.5f, 4.5f}, {1, 0, 0}).face, Face::kNegativeX);
  EXPECT_EQ(scene.cast({5, 4.5f, 4.5f}, {-1, 0, 0}).face, Face::kPositiveX);
  EXPECT_FALSE(scene.cast({5, 4.5f, 4.5f}, {1, 0, 0}).hit);
  EXPECT_FALSE(scene.cast({4, 4.5f, 4.5f}, {-1, 0, 0}).hit);
}

TEST(CastRules, ARayInAPlaneIsInTheVoxelAboveIt) {
  const Scene scene({{4, 4, 4}});
  for (const float zero : {0.0f, -0.0f, 1e-30f, -1e-30f, 1e-45f}) {
    EXPECT_TRUE(scene.cast({0, 4, 4}, {1, zero, zero}).hit);
    EXPECT_FALSE(scene.cast({0, 5, 4}, {1, zero, zero}).hit);
    EXPECT_FALSE(scene.cast({0, 4, 5}, {1, zero, zero}).hit);
    EXPECT_FALSE(scene.cast({0, 3.99f, 4}, {1, zero, zero}).hit);
    EXPECT_EQ(scene.cast({4.5f, 4, 4}, {1, zero, zero}).face, Face::kNone);
  }
}

TEST(CastRules, ThroughAnEdgeOrCornerARayPassesToTheDiagonalNeighbour) {
  const Scene beside({{4, 3, 3}, {3, 4, 3}, {3, 3, 4}, {4, 4, 3}, {3, 4, 4}, {4, 3, 4}});
  EXPECT_FALSE(beside.cast({1, 1, 1}, {1, 1, 1}).hit);
  EXPECT_FALSE(beside.cast({7, 7, 7}, {-1, -1, -1}).hit);
  const Scene behind({{4, 4, 4}});
  EXPECT_EQ(behind.cast({1, 1, 1}, {1, 1, 1}).face, Face::kNegativeX);
}

TEST(CastRules, BothEndsOfTheRangeBelongToIt) {
  const Scene scene({{4, 4, 4}});
  EXPECT_TRUE(scene.cast({0, 4.5f, 4.5f}, {1, 0, 0}, 0, 4).hit);
  EXPECT_FALSE(scene.cast({0, 4.5f, 4.5f}, {1, 0, 0}, 0, 3.999f).hit);
  EXPECT_TRUE(scene.cast({0, 4.5f, 4.5f}, {1, 0, 0}, 4.999f, 9).hit);
  EXPECT_FALSE(scene.cast({0, 4.5f, 4.5f}, {1, 0, 0}, 5, 9).hit);
}

TEST(CastRules, ARangeMayEndAtMinusZero) {
  const Scene scene({{4, 4, 4}});
  EXPECT_TRUE(scene.cast({4.5f, 4.5f, 4.5f}, {1, 2, 3}, 0.0f, -0.0f).hit);
  const GridPoint start{{1.5f, 1.5f, 1.5f}};
  EXPECT_FALSE(std::signbit(make_grid_ray(start, {1, 2, 3}, 0.0f, -0.0f).t_max));
}

TEST(CastRules, NegativeTIsBehindTheOrigin) {
  const Scene scene({{2, 4, 4}});
  EXPECT_FALSE(scene.cast({6, 4.5f, 4.5f}, {1, 0, 0}).hit);
  const Hit hit = scene.cast({6, 4.5f, 4.5f}, {1, 0, 0}, -kInfinity);
  EXPECT_TRUE(hit.hit);
  EXPECT_EQ(hit.t, -4.0f);
  EXPECT_EQ(hit.face, Face::kNegativeX);
  EXPECT_FALSE(scene.cast({6, 4.5f, 4.5f}, {1, 0, 0}, -2).hit);
}

TEST(CastRules, InvalidRaysMeetNothing) {
  const Scene scene(voxels_where(3, [](Vec3i) { return true; }));
  const Vec3f in{4.5f, 4.5f, 4.5f};
  EXPECT_TRUE(scene.cast(in, {1, 0, 0}).hit);
  EXPECT_FALSE(scene.cast(in, {0, 0, 0}).hit);
  EXPECT_FALSE(scene.cast(in, {1, 0, 0}, 2, 1).hit);
  EXPECT_FALSE(scene.cast(in, {1, 0, 0}, kInfinity).hit);
  EXPECT_FALSE(scene.cast(in, {1, 0, 0}, -kInfinity, -kInfinity).hit);
  for (const float bad : {kNan, kInfinity, -kInfinity}) {
    EXPECT_FALSE(scene.cast({bad, 4, 4}, {1, 0, 0}).hit);
    EXPECT_FALSE(scene.cast({4, 4, bad}, {1, 0, 0}).hit);
    EXPECT_FALSE(scene.cast(in, {1, bad, 0}).hit);
  }
  EXPECT_FALSE(scene.cast(in, {1, 0, 0}, kNan).hit);
  EXPECT_FALSE(scene.cast(in, {1, 0, 0}, 0, kNan).hit);
}

TEST(CastRules, DenormalDirectionsAreDirections) {
  const Scene scene({{4, 4, 4}});
  const float least = std::numeric_limits<float>::denorm_min();
  EXPECT_TRUE(scene.cast({0.5f, 0.5f, 0.5f}, {least, least, least}).hit);
  EXPECT_FALSE(scene.cast({0.5f, 0.5f, 0.5f}, {least, least, 0}).hit);
}

TEST(CastRules, TheRootIsEnteredFromAnyDistance) {
  const Scene scene(voxels_where(3, [](Vec3i) { return true; }));
  for (const float far : {1e2f, 1e6f, 1e18f, 1e37f}) {
    EXPECT_EQ(scene.cast({-far, 4.5f, 4.5f}, {1, 0, 0}).face, Face::kNegativeX);
    EXPECT_EQ(scene.cast({4.5f, far, 4.5f}, {0, -1, 0}).face, Face::kPositiveY);
    EXPECT_FALSE(scene.cast({4.5f, far, 4.5f}, {0, 1, 0}).hit);
  }
}

TEST(CastRules, StopEndsTheCastAtTheFirstCellOfThatLevel) {
  const int levels = 6;
  Grid grid;
  grid.levels = levels;
  std::mt19937 rng(2);
  const auto voxels = voxels_where(levels, [&](Vec3i) { return rng() % 400 == 0; });
  const Svdag fine = brute_svdag(levels, voxels);
  for (int level = 2; level < levels; ++level) {
    std::vector<Vec3i> cells;
    for (const Vec3i v : voxels)
      cells.push_back({v.x >> (levels - level), v.y >> (levels - level), v.z >> (levels - level)});
    const Svdag coarse = brute_svdag(level, cells);
    Grid coarse_grid;
    coarse_grid.levels = level;
    coarse_grid.voxel_size = 1 << (levels - level);
    TestRays rays(grid, 31);
    for (int i = 0; i < 5000; ++i) {
      const Ray ray = rays.make(static_cast<RayKind>(i % static_cast<int>(RayKind::kCount)));
      const auto stop = [level](int at, float, float) { return at == level; };
      const Hit hit = closest_hit(SvdagNodes(fine.view()), grid, ray, stop);
      Hit expected = closest_hit(SvdagNodes(coarse.view()), coarse_grid, ray);
      for (int axis = 0; axis < 3; ++axis) expected.voxel[axis] <<= levels - level;
      ASSERT_EQ(hit, expected) << "level " << level << ", ray " << i;
    }
  }
}

TEST(CastRules, StopReceivesTheRangeOfTInTheCell) {
  const Svdag dag = brute_svdag(3, {{4, 4, 4}});
  Grid grid;
  grid.levels = 3;
  std::vector<std::array<float, 3>> asked;
  const auto stop = [&](int level, float t_enter, float t_exit) {
    asked.push_back({static_cast<float>(level), t_enter * 8, t_exit * 8});
    return false;
  };
  EXPECT_TRUE(closest_hit(SvdagNodes(dag.view()), grid,
                          Ray{{0.5f, 4.5f, 4.5f}, 0, {1, 0, 0}, kInfinity}, stop)
                  .hit);
  const std::vector<std::array<float, 3>> expected{{1, 3.5f, 7.5f}, {2, 3.5f, 5.5f}};
  EXPECT_EQ(asked, expected);
}

}  // namespace
}  // namespace voxdag
