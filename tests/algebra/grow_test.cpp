#include "voxdag/algebra/grow.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>

#include "support/with_threads.hpp"
#include "voxel_grid.hpp"

namespace voxdag {
namespace {

/// Returns whether is_wanted(p) holds at all places p (outside the grid, too) that are `steps`
/// steps or less away from v.
template <class IsWanted>
bool all_near(Vec3i v, int steps, Neighbours neighbours, const IsWanted& is_wanted) {
  for (int z = -steps; z <= steps; ++z)
    for (int y = -steps; y <= steps; ++y)
      for (int x = -steps; x <= steps; ++x) {
        const bool is_near =
            neighbours == Neighbours::k26 || std::abs(x) + std::abs(y) + std::abs(z) <= steps;
        if (is_near && !is_wanted(v + Vec3i{x, y, z})) return false;
      }
  return true;
}

TEST(Grow, DilationAndErosionAreThoseOfTheVoxels) {
  for (const int levels : {2, 3, 4})
    for (const NamedVoxels& set : voxel_sets(levels, 21)) {
      const VoxelGrid grid(levels, set.voxels);
      const Svdag dag = brute_svdag(levels, set.voxels);
      for (const Neighbours neighbours : {Neighbours::k6, Neighbours::k26})
        for (const int steps : {0, 1, 2, 3, 5, 8}) {
          if (levels == 4 && steps > 3) continue;
          ASSERT_EQ(dilate(dag.view(), steps, neighbours),
                    VoxelGrid::dag_of(levels,
                                      [&](Vec3i v) {
                                        return !all_near(v, steps, neighbours, [&](Vec3i p) {
                                          return !grid.contains(p);
                                        });
                                      }))
              << set.name << ", " << steps << " steps, " << levels << " levels";
          ASSERT_EQ(erode(dag.view(), steps, neighbours),
                    VoxelGrid::dag_of(levels,
                                      [&](Vec3i v) {
                                        return all_near(v, steps, neighbours,
                                                        [&](Vec3i p) { return grid.contains(p); });
                                      }))
              << set.name << ", " << steps << " steps, " << levels << " levels";
        }
    }
}

TEST(Grow, ThreadsShareTheCellsOfALargeLevel) {
  constexpr int kLevels = 7;
  std::mt19937 rng(3);
  const std::vector<Vec3i> voxels = voxels_where(kLevels, [&](Vec3i) { return rng() % 50 == 0; });
  const VoxelGrid grid(kLevels, voxels);
  const Svdag dag = brute_svdag(kLevels, voxels);
  const Svdag expected = VoxelGrid::dag_of(kLevels, [&](Vec3i v) {
    return !all_near(v, 1, Neighbours::k26, [&](Vec3i p) { return !grid.contains(p); });
  });
  for (const std::size_t threads : {1u, 2u, 5u})
    EXPECT_EQ(with_threads(threads, [&] { return dilate(dag.view(), 1, Neighbours::k26); }),
              expected);
}

TEST(Grow, AVoxelOfALargeGridBecomesACube) {
  const Svdag dag = brute_svdag(16, {{30'000, 4, 65'535}});
  const Svdag grown = dilate(dag.view(), 6, Neighbours::k26);
  std::vector<Vec3i> cube;
  for (int z = 65'529; z <= 65'535; ++z)
    for (int y = 0; y <= 10; ++y)
      for (int x = 29'994; x <= 30'006; ++x) cube.push_back({x, y, z});
  EXPECT_EQ(grown, brute_svdag(16, cube));
  EXPECT_EQ(dilate(dilate(dag.view(), 2, Neighbours::k26).view(), 4, Neighbours::k26), grown);
  const Svdag all = dilate(brute_svdag(5, {{7, 0, 31}}).view(), 1'000'000'000, Neighbours::k26);
  EXPECT_EQ(all.leaf_blocks, std::vector<std::uint64_t>{~std::uint64_t{0}});
  EXPECT_TRUE(erode(all.view(), 1'000'000'000, Neighbours::k6).view().is_empty());
}

TEST(Grow, BoxesGrowFarInsideTheGridAndAtItsSides) {
  constexpr int kLevels = 5;
  std::mt19937 rng(7);
  for (const int first : {0, 12}) {
    std::vector<Vec3i> voxels;
    for (int i = 0; i < 6; ++i)
      voxels.push_back({first + int(rng() % 8), first + int(rng() % 8), first + int(rng() % 8)});
    const Svdag dag = brute_svdag(kLevels, voxels);
    for (const Vec3i half : {Vec3i{4, 0, 1}, {5, 7, 2}, {12, 9, 10}, {31, 1, 3}})
      EXPECT_EQ(
          dilate_box(dag.view(), half, {}),
          VoxelGrid::dag_of(kLevels,
                            [&](Vec3i v) {
                              return std::any_of(voxels.begin(), voxels.end(), [&](Vec3i voxel) {
                                const Vec3i away = v - voxel;
                                return std::abs(away.x) <= half.x && std::abs(away.y) <= half.y &&
                                       std::abs(away.z) <= half.z;
                              });
                            }))
          << first << ", " << half.x << ", " << half.y << ", " << half.z;
  }
}

}  // namespace
}  // namespace voxdag
