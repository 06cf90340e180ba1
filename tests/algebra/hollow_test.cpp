#include "voxdag/algebra/hollow.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "algebra/brute_depths.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/algebra/query/distance_field.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/stored/svdag/svdag_lookup.hpp"

namespace voxdag {
namespace {

bool in_ball(Vec3i v, Vec3d centre, double radius) {
  const Vec3d apart = Vec3d(v) + Vec3d{0.5, 0.5, 0.5} - centre;
  return dot(apart, apart) <= radius * radius;
}

/// A body with a flat side at the grid's lower end, a hole and a corner.
bool in_body(Vec3i v) {
  return (in_ball(v, {9, 8, 4}, 7.5) || (v.x > 10 && v.y > 10 && v.z < 9)) &&
         !in_ball(v, {6, 8, 4}, 1.5);
}

TEST(Hollow, KeepsTheVoxelsThatAreAsDeepAsTheWallInAnyMemory) {
  constexpr int kLevels = 4;
  const std::vector<Vec3i> voxels = voxels_where(kLevels, in_body);
  const VoxelGrid grid(kLevels, voxels);
  std::vector<std::int64_t> squares;
  for (const Vec3i v : voxels) squares.push_back(brute_depth_square(grid, v));
  const Svdag body = brute_svdag(kLevels, voxels);
  for (const double wall : {0.2, 0.5, 1.0, 1.6, 2.5, 3.0, 40.0}) {
    std::vector<Vec3i> kept;
    for (std::size_t i = 0; i < voxels.size(); ++i)
      if (static_cast<double>(squares[i]) <= 4 * wall * wall) kept.push_back(voxels[i]);
    const Svdag expected = brute_svdag(kLevels, kept);
    EXPECT_EQ(keep_wall(body.view(), wall), expected) << wall;
    MemoryBudget memory(std::uint64_t{300} << 10);
    if (wall < 4) {
      EXPECT_EQ(keep_wall(body.view(), wall, Work(&memory)), expected) << wall;
    }
  }
  EXPECT_TRUE(keep_wall(VoxelGrid::dag_of(kLevels, [](Vec3i) { return false; }).view(), 2)
                  .view()
                  .is_empty());
}

TEST(Hollow, ABoxKeepsAFlatWallOfWholeVoxels) {
  constexpr int kLevels = 7;  // Several cubes.
  const auto in_box = [](Vec3i v, std::int32_t inset) {
    return v.x >= 10 + inset && v.x < 100 - inset && v.y >= inset && v.y < 128 - inset &&
           v.z >= 50 + inset && v.z < 80 - inset;
  };
  const Svdag box = VoxelGrid::dag_of(kLevels, [&](Vec3i v) { return in_box(v, 0); });
  const Svdag expected =
      VoxelGrid::dag_of(kLevels, [&](Vec3i v) { return in_box(v, 0) && !in_box(v, 7); });
  EXPECT_EQ(keep_wall(box.view(), 7), expected);
  EXPECT_EQ(keep_wall(box.view(), 7.4), expected);
  EXPECT_EQ(keep_wall(box.view(), 6.5), expected);
}

TEST(Hollow, ADrainIsARoundHoleToTheCavity) {
  constexpr int kLevels = 5;
  const auto in_box = [](Vec3i v) {
    return v.x >= 4 && v.x < 28 && v.y >= 4 && v.y < 28 && v.z >= 4 && v.z < 28;
  };
  const Svdag box = VoxelGrid::dag_of(kLevels, in_box);
  const Drain drain{{16.5, 16.5, 4}, 2};
  const Svdag open = hollow(box.view(), 3, {&drain, 1}), closed = keep_wall(box.view(), 3);
  for (const Vec3i v : voxels_where(kLevels, in_box)) {
    const double x = v.x - 16, y = v.y - 16;
    const bool is_hole = v.z < 9 && x * x + y * y <= 4;
    EXPECT_EQ(svdag_contains(open.view(), v, kLevels),
              !is_hole && svdag_contains(closed.view(), v, kLevels));
  }
}

TEST(Hollow, WhatCannotBeHollowIsRefused) {
  constexpr int kLevels = 5;
  const Svdag ball = VoxelGrid::dag_of(kLevels, [](Vec3i v) {
    return in_ball(v, {16, 16, 16}, 12);
  });
  const auto reason = [&](double wall, std::vector<Drain> drains) {
    try {
      hollow(ball.view(), wall, drains);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(reason(3, {}), "");
  EXPECT_EQ(reason(12, {}), "has no voxels that are deeper than the wall");
  EXPECT_EQ(reason(3, {{{16, 16, 4}, 1.5}}), "");
  // The first does not reach the surface.
  EXPECT_EQ(reason(3, {{{16, 16, 7}, 1.5}}).substr(0, 32), "drain 1 does not open the cavity");
}

TEST(DepthSquares, AreFourTimesTheSquaredDistancesToEmptyPlaces) {
  constexpr int kLevels = 3;
  const auto set = [](Vec3i v) { return (v.x * 7 + v.y * 5 + v.z * 3) % 11 != 0; };
  const VoxelGrid grid(kLevels, voxels_where(kLevels, set));
  const Box3i box{{-1, -1, -1}, {9, 9, 9}};
  const auto squares = depth_squares(VoxelGrid::dag_of(kLevels, set).view(), box, {});
  std::size_t i = 0;
  for (std::int32_t z = -1; z < 9; ++z)
    for (std::int32_t y = -1; y < 9; ++y)
      for (std::int32_t x = -1; x < 9; ++x, ++i)
        ASSERT_EQ(squares[i], grid.contains({x, y, z}) ? brute_depth_square(grid, {x, y, z}) : 0);
}

}  // namespace
}  // namespace voxdag
