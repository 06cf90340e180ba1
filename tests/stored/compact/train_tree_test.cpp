#include "voxdag/stored/compact/train_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace voxdag {
namespace {

/// The symbol depends on features 3 and 40; the others are noise.
std::vector<ContextSample> samples(std::uint64_t seed, std::size_t count) {
  std::mt19937_64 random(seed);
  std::vector<ContextSample> samples(count);
  for (ContextSample& s : samples) {
    s.features = random();
    const auto first = static_cast<std::uint32_t>(s.features >> 3 & 1);
    const auto second = static_cast<std::uint32_t>(s.features >> 40 & 1);
    s.symbol =
        10 * first + (first != 0 ? 5 * second : 0) + static_cast<std::uint32_t>(random() % 2);
  }
  return samples;
}

TEST(TrainTree, FindsTheFeaturesThatMatterAndNoOthers) {
  std::vector<ContextSample> of = samples(1, 5000);
  const ContextTree tree = train_tree(of, {}, {});
  ASSERT_EQ(tree.tables(), 3u);
  EXPECT_EQ(tree.nodes[0] & 63u, 3u);
  EXPECT_EQ(tree.table(0), tree.table(std::uint64_t{1} << 40));
  EXPECT_NE(tree.table(8), tree.table(8 | std::uint64_t{1} << 40));
}

TEST(TrainTree, DoesNotDependOnTheOrderOfTheSamples) {
  std::vector<ContextSample> of = samples(2, 3000), shuffled = of;
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937_64(7));
  EXPECT_EQ(train_tree(of, {}, {}).nodes, train_tree(shuffled, {}, {}).nodes);
}

TEST(TrainTree, KeepsToTheLimits) {
  std::vector<ContextSample> of = samples(3, 3000);
  EXPECT_EQ(train_tree(of, {64, 2, 1}, {}).tables(), 2u);
  EXPECT_EQ(train_tree(of, {40, 100, 1}, {}).tables(), 2u);  // feature 40 is not used
  EXPECT_EQ(train_tree({}, {}, {}).tables(), 1u);
}

TEST(TrainTree, SplitsNothingIfTheModelWouldCostMore) {
  std::vector<ContextSample> of = samples(4, 40);
  EXPECT_EQ(train_tree(of, {}, {}).tables(), 1u);
}

}  // namespace
}  // namespace voxdag
