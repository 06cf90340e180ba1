#include "voxdag/stored/svdag/for_each_voxel.hpp"

#include <gtest/gtest.h>

#include <set>

#include "support/brute_svdag.hpp"
#include "voxdag/stored/svdag/svdag_lookup.hpp"

namespace voxdag {
namespace {

/// Returns the voxels inside the window, once each, in Morton order. Sorts their codes.
std::vector<Vec3i> sorted_inside(const std::vector<Vec3i>& voxels, const Box3i& window) {
  std::set<std::uint64_t> codes;
  for (const Vec3i v : voxels)
    if (max(v, window.lo) == v && max(v + Vec3i{1, 1, 1}, window.hi) == window.hi)
      codes.insert(morton_encode(v));
  std::vector<Vec3i> sorted;
  for (const std::uint64_t code : codes) sorted.push_back(morton_decode(code));
  return sorted;
}

std::vector<Vec3i> walked(const SvdagView& dag, const Box3i& window) {
  std::vector<Vec3i> voxels;
  for_each_voxel(dag, window, [&](Vec3i v) { voxels.push_back(v); });
  return voxels;
}

TEST(ForEachVoxel, GivesEveryVoxelOnceInMortonOrder) {
  for (int levels = 2; levels <= 8; ++levels)
    for (unsigned seed = 0; seed < 5; ++seed) {
      const std::vector<Vec3i> voxels = random_voxels(levels, 200, seed);
      const Svdag dag = brute_svdag(levels, voxels);
      EXPECT_EQ(walked(dag.view(), whole_grid(levels)), sorted_inside(voxels, whole_grid(levels)));
    }
}

TEST(ForEachVoxel, KeepsToTheWindow) {
  std::mt19937 rng(1);
  const int levels = 5;
  const std::vector<Vec3i> voxels = random_voxels(levels, 3000, 1);
  const Svdag dag = brute_svdag(levels, voxels);
  const auto coordinate = [&] { return static_cast<std::int32_t>(rng() % 40) - 4; };
  for (int i = 0; i < 300; ++i) {
    const Box3i window{{coordinate(), coordinate(), coordinate()},
                       {coordinate(), coordinate(), coordinate()}};
    EXPECT_EQ(walked(dag.view(), window), sorted_inside(voxels, window));
  }
}

TEST(ForEachVoxel, AnEmptyDagHasNone) {
  EXPECT_TRUE(walked(brute_svdag(9, {}).view(), whole_grid(9)).empty());
}

TEST(ForEachVoxel, ReachesTheFarCornerOfTheLargestGrid) {
  const Vec3i corner{1048575, 1048575, 1048575};
  const Svdag dag = brute_svdag(kMaxLevels, {corner});
  EXPECT_EQ(walked(dag.view(), whole_grid(kMaxLevels)), std::vector<Vec3i>{corner});
  EXPECT_TRUE(svdag_contains(dag.view(), corner, dag.levels));
}

TEST(HasVoxel, AgreesWithTheSetEverywhereAndOutside) {
  for (int levels = 2; levels <= 4; ++levels) {
    const std::vector<Vec3i> voxels = random_voxels(levels, 60, 2);
    const Svdag dag = brute_svdag(levels, voxels);
    std::set<std::uint64_t> codes;
    for (const Vec3i v : voxels) codes.insert(morton_encode(v));
    const int n = 1 << levels;
    for (int z = -5; z < n + 5; ++z)
      for (int y = -5; y < n + 5; ++y)
        for (int x = -5; x < n + 5; ++x) {
          const bool inside = x >= 0 && y >= 0 && z >= 0 && x < n && y < n && z < n;
          EXPECT_EQ(svdag_contains(dag.view(), {x, y, z}, dag.levels),
                    inside && codes.contains(morton_encode({x, y, z})));
        }
  }
}

}  // namespace
}  // namespace voxdag
