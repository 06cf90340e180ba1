// Tests the reference builder itself: small cases worked out by hand, and counts compared with the
// octree.
#include "support/brute_svdag.hpp"

#include <gtest/gtest.h>

#include <set>
#include <tuple>

#include "voxdag/core/morton.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"

namespace voxdag {
namespace {

/// Lists the voxels in Morton order by walking the view from the root.
void walk(const SvdagView& dag, int level, std::uint64_t at, Vec3i cell,
          std::vector<Vec3i>& voxels) {
  const auto child_cell = [](Vec3i c, int i) { return c * 2 + child_offset(i); };
  if (level == dag.levels - 2) {
    for (int i = 0; i < 64; ++i)
      if (dag.leaf_blocks[at] >> i & 1)
        voxels.push_back(child_cell(child_cell(cell, i / 8), i % 8));
    return;
  }
  const std::uint32_t* node = dag.nodes + at;
  for (int i = 0; i < 8; ++i)
    if (child_mask(node) >> i & 1)
      walk(dag, level + 1, child_pointer(node, i), child_cell(cell, i), voxels);
}

std::set<std::tuple<int, int, int>> as_set(const std::vector<Vec3i>& voxels) {
  std::set<std::tuple<int, int, int>> set;
  for (const Vec3i v : voxels) set.insert({v.x, v.y, v.z});
  return set;
}

TEST(BruteSvdag, NoVoxelsMakeNoNodes) {
  const Svdag dag = brute_svdag(5, {});
  EXPECT_TRUE(dag.view().is_empty());
  EXPECT_TRUE(dag.nodes.empty());
  EXPECT_EQ(dag.view().node_words(), 0u);
}

TEST(BruteSvdag, OneVoxelInOneLeafBlock) {
  const Svdag dag = brute_svdag(2, {{3, 0, 0}});
  EXPECT_EQ(dag.leaf_blocks, (std::vector<std::uint64_t>{std::uint64_t{1} << (8 * 1 + 1)}));
  EXPECT_TRUE(dag.nodes.empty());
}

TEST(BruteSvdag, EqualBlocksAreMerged) {
  // Voxel (0,0,0) and its copy in child 7, and a different block in child 1.
  const Svdag dag = brute_svdag(3, {{0, 0, 0}, {4, 4, 4}, {7, 3, 3}});
  EXPECT_EQ(dag.nodes, (std::vector<std::uint32_t>{0b10000011, 0, 1, 0}));
  EXPECT_EQ(dag.leaf_blocks, (std::vector<std::uint64_t>{1, std::uint64_t{1} << 63}));
  EXPECT_EQ(dag.level_begin[0], 0u);
  EXPECT_EQ(dag.level_begin[1], 4u);
  EXPECT_EQ(dag.level_begin[kMaxLevels], 4u);
}

TEST(BruteSvdag, OrderIsDepthFirstFirstVisit) {
  // Two level-1 nodes. The walk meets the only child of the first one before that of the second
  // one.
  const Svdag dag = brute_svdag(4, {{0, 0, 0}, {15, 15, 15}});
  EXPECT_EQ(dag.nodes,
            (std::vector<std::uint32_t>{0b10000001, 3, 5, 0b00000001, 0, 0b10000000, 1}));
  EXPECT_EQ(dag.leaf_blocks, (std::vector<std::uint64_t>{1, std::uint64_t{1} << 63}));
}

TEST(BruteSvdag, AFullGridHasOneNodePerLevel) {
  std::vector<Vec3i> voxels;
  for (int i = 0; i < 16 * 16 * 16; ++i) voxels.push_back({i & 15, i >> 4 & 15, i >> 8});
  const Svdag dag = brute_svdag(4, voxels);
  EXPECT_EQ(dag.nodes.size(), 18u);
  EXPECT_EQ(dag.leaf_blocks, (std::vector<std::uint64_t>{~std::uint64_t{0}}));
}

TEST(BruteSvdag, TheDagHoldsExactlyTheVoxelsGiven) {
  for (int levels = 2; levels <= 7; ++levels)
    for (unsigned seed = 0; seed < 10; ++seed) {
      const std::vector<Vec3i> voxels = random_voxels(levels, 40, seed);
      const Svdag dag = brute_svdag(levels, voxels);
      std::vector<Vec3i> found;
      walk(dag.view(), 0, 0, {0, 0, 0}, found);
      EXPECT_EQ(as_set(found), as_set(voxels));
      EXPECT_EQ(found.size(), as_set(voxels).size());
    }
}

TEST(BruteSvdag, CountsMatchTheOctree) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const int levels = 6;
    const std::vector<Vec3i> voxels = random_voxels(levels, 100, seed);
    const SvdagCounts counts = count_svdag(brute_svdag(levels, voxels).view());
    EXPECT_EQ(counts.voxels, as_set(voxels).size());
    for (int level = 0; level < levels; ++level) {
      std::set<std::tuple<int, int, int>> cells;
      const int shift = levels - level;
      for (const Vec3i v : voxels) cells.insert({v.x >> shift, v.y >> shift, v.z >> shift});
      EXPECT_EQ(counts.svo_nodes_per_level[level], cells.size());
      EXPECT_LE(counts.dag_nodes_per_level[level], cells.size());
    }
  }
}

}  // namespace
}  // namespace voxdag
