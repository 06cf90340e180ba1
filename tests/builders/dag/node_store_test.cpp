#include "voxdag/builders/dag/node_store.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <vector>

#include "voxdag/core/bits.hpp"
#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/core/parallel/per_thread.hpp"

namespace voxdag {
namespace {

std::vector<std::uint32_t> node(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<std::uint32_t> words{static_cast<std::uint32_t>(1 + random() % 255)};
  for (int i = popcount(words[0]); i > 0; --i)
    words.push_back(static_cast<std::uint32_t>(random() % 5000));
  return words;
}

TEST(NodeStore, EqualWordsFromAnyThreadGetOneId) {
  MemoryBudget budget;
  NodeStore store(budget);
  constexpr std::uint32_t kNodes = 200000, kDistinct = 50000;
  std::vector<NodeId> ids(kNodes);
  PerThread<NodeStore::Run> runs;
  parallel_for(kNodes, 64, [&](std::size_t i) {
    const auto words = node(static_cast<std::uint32_t>(i % kDistinct));
    const int count = static_cast<int>(words.size());
    const std::uint64_t hash = hash_words(words.data(), count);
    store.prefetch(hash);
    store.prefetch_found(hash);
    ids[i] = store.intern(words.data(), count, hash, runs.local());
  });
  std::map<std::vector<std::uint32_t>, NodeId> expected;
  for (std::uint32_t i = 0; i < kNodes; ++i) {
    const auto words = node(i % kDistinct);
    ASSERT_EQ(expected.try_emplace(words, ids[i]).first->second, ids[i]);
    ASSERT_TRUE(std::equal(words.begin(), words.end(), store.words(ids[i])));
  }
  EXPECT_EQ(store.node_count(), expected.size());
}

TEST(NodeStore, CountsTheMemoryItHolds) {
  MemoryBudget budget;
  {
    NodeStore store(budget);
    NodeStore::Run run;
    for (std::uint32_t i = 0; i < 10000; ++i) {
      const std::uint32_t words[2] = {i, ~i};
      store.intern(words, 2, hash_words(words, 2), run);
    }
    EXPECT_EQ(store.word_count(), 20000u);
    EXPECT_GE(budget.used(), 10000u * (8 + 8));
    store.release_slots();
    // The memory of all words, and the unused part of the last run.
    EXPECT_GE(budget.used(), 80000u);
    EXPECT_LT(budget.used(), 90000u);
  }
  EXPECT_EQ(budget.used(), 0u);
}

TEST(MemoryBudget, ReportsThatItsLimitWasExceeded) {
  MemoryBudget budget(100);
  budget.add(100);
  EXPECT_FALSE(budget.exceeded());
  budget.add(1);
  EXPECT_TRUE(budget.exceeded());
  EXPECT_EQ(budget.peak(), 101u);
}

}  // namespace
}  // namespace voxdag
