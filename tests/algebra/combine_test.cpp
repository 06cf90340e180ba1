#include "voxdag/algebra/combine.hpp"

#include <gtest/gtest.h>

#include "voxel_grid.hpp"

namespace voxdag {
namespace {

struct Operation {
  SetOperation operation;
  const char* name;
  bool (*keeps)(bool, bool);
};
constexpr Operation kOperations[] = {
    {SetOperation::kUnion, "union", [](bool a, bool b) { return a || b; }},
    {SetOperation::kIntersection, "intersection", [](bool a, bool b) { return a && b; }},
    {SetOperation::kDifference, "difference", [](bool a, bool b) { return a && !b; }},
    {SetOperation::kSymmetric, "symmetric difference", [](bool a, bool b) { return a != b; }},
};

TEST(Combine, IsTheDagOfTheCombinedVoxels) {
  for (const int levels : {2, 3, 4, 5}) {
    const std::vector<NamedVoxels> first = voxel_sets(levels, 3), second = voxel_sets(levels, 4);
    for (const NamedVoxels& a : first)
      for (const NamedVoxels& b : second) {
        const VoxelGrid in_a(levels, a.voxels), in_b(levels, b.voxels);
        const Svdag dag_a = brute_svdag(levels, a.voxels), dag_b = brute_svdag(levels, b.voxels);
        for (const auto& [operation, name, keeps] : kOperations)
          ASSERT_EQ(combine(dag_a.view(), dag_b.view(), operation),
                    VoxelGrid::dag_of(levels,
                                      [&, keep = keeps](Vec3i v) {
                                        return keep(in_a.contains(v), in_b.contains(v));
                                      }))
              << a.name << " " << name << " " << b.name << ", " << levels << " levels";
      }
  }
}

TEST(Combine, FollowsTheLawsOfSets) {
  const std::vector<Vec3i> some = random_voxels(6, 4000, 1), others = random_voxels(6, 4000, 2);
  const Svdag a = brute_svdag(6, some), b = brute_svdag(6, others);
  const auto join = [](const Svdag& x, const Svdag& y, SetOperation operation) {
    return combine(x.view(), y.view(), operation);
  };
  const Svdag both = join(a, b, SetOperation::kIntersection);
  EXPECT_EQ(join(a, a, SetOperation::kUnion), a);
  EXPECT_EQ(join(a, a, SetOperation::kIntersection), a);
  EXPECT_TRUE(join(a, a, SetOperation::kDifference).view().is_empty());
  EXPECT_EQ(join(join(a, b, SetOperation::kDifference), both, SetOperation::kUnion), a);
  EXPECT_EQ(join(join(a, b, SetOperation::kSymmetric), b, SetOperation::kSymmetric), a);
  EXPECT_EQ(join(join(a, b, SetOperation::kUnion), both, SetOperation::kDifference),
            join(a, b, SetOperation::kSymmetric));
}

TEST(Combine, CostsAFewNodesForFullGridsOfAnySize) {
  Svdag full;
  full.levels = kMaxLevels;
  for (int level = 0; level < kMaxLevels - 2; ++level) {
    const std::uint32_t next =
        level == kMaxLevels - 3 ? 0 : static_cast<std::uint32_t>(9 * (level + 1));
    full.level_begin[static_cast<std::size_t>(level)] = full.nodes.size();
    full.nodes.push_back(0xFF);
    full.nodes.insert(full.nodes.end(), 8, next);
  }
  for (int level = kMaxLevels - 2; level <= kMaxLevels; ++level)
    full.level_begin[static_cast<std::size_t>(level)] = full.nodes.size();
  full.leaf_blocks = {~std::uint64_t{0}};
  const Svdag voxel = brute_svdag(kMaxLevels, {{12345, 678901, 234567}});
  MemoryBudget budget(1 << 20);
  const Svdag holed = combine(full.view(), voxel.view(), SetOperation::kDifference, &budget);
  EXPECT_LT(holed.nodes.size(), 2u * 9 * kMaxLevels);
  EXPECT_EQ(combine(holed.view(), voxel.view(), SetOperation::kUnion, &budget), full);
  EXPECT_EQ(combine(full.view(), holed.view(), SetOperation::kSymmetric, &budget), voxel);
}

TEST(Combine, KeepsALimitOrIsRefused) {
  const Svdag a = brute_svdag(6, random_voxels(6, 20000, 1)),
              b = brute_svdag(6, random_voxels(6, 20000, 2));
  MemoryBudget enough(64 << 20), small(64 << 10);
  const Svdag expected = combine(a.view(), b.view(), SetOperation::kUnion);
  EXPECT_EQ(combine(a.view(), b.view(), SetOperation::kUnion, &enough), expected);
  EXPECT_EQ(enough.used(), 0u);
  EXPECT_THROW(combine(a.view(), b.view(), SetOperation::kUnion, &small), OverMemory);
  EXPECT_EQ(small.used(), 0u);
}

TEST(Combine, EndsWhenCancelled) {
  const Svdag a = brute_svdag(4, random_voxels(4, 100, 1));
  Progress progress;
  progress.cancel();
  EXPECT_THROW(combine(a.view(), a.view(), SetOperation::kUnion, &progress), Cancelled);
}

}  // namespace
}  // namespace voxdag
