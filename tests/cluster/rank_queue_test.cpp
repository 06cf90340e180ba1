#include "voxdag/cluster/rank_queue.hpp"

#include <gtest/gtest.h>

#include <array>

#include "ranks_under_test.hpp"
#include "voxdag/cluster/ranks_per_machine.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

constexpr int kQueueCounter = 3;

TEST(RankQueue, DoesEveryItemOnceAndGivesAllResultsToAllRanks) {
  constexpr std::size_t kItems = 500;
  RankQueue queue(ranks(), kQueueCounter);
  for (int round = 0; round < 2; ++round) {
    std::array<std::uint64_t, kItems> mine{};
    const auto squares = results_of<std::uint64_t>(queue, kItems, [&](std::size_t item) {
      ++mine[item];
      return item * item;
    });
    for (std::size_t item = 0; item < kItems; ++item) EXPECT_EQ(squares[item], item * item);
    std::array<std::uint64_t, kItems> times{};
    const std::vector<std::uint64_t> all = ranks().all_gather(mine);
    for (std::size_t i = 0; i < all.size(); ++i) times[i % kItems] += all[i];
    for (std::size_t item = 0; item < kItems; ++item) EXPECT_EQ(times[item], 1u) << item;
  }
}

TEST(RankQueue, ARankTakesItemsInAscendingOrder) {
  RankQueue queue(ranks(), kQueueCounter);
  std::size_t next = 0;
  queue.run(100, 0, [&](std::size_t item, std::span<std::byte> result) {
    EXPECT_GE(item, next);
    EXPECT_TRUE(result.empty());
    next = item + 1;
  });
}

TEST(RankQueue, NoItemsGiveNoResults) {
  RankQueue queue(ranks(), kQueueCounter);
  EXPECT_TRUE(results_of<int>(queue, 0, [](std::size_t) { return 1; }).empty());
}

TEST(RankQueue, RanksThatHaveDifferentItemsAreAnError) {
  if (ranks().count() == 1) GTEST_SKIP() << "one rank";
  RankQueue queue(ranks(), kQueueCounter);
  const auto count = static_cast<std::size_t>(5 + ranks().rank());
  EXPECT_THROW(results_of<int>(queue, count, [](std::size_t) { return 1; }), Error);
}

TEST(RanksPerMachine, CountsTheRanksOfThisMachine) {
  const RanksPerMachine counts = ranks_per_machine(ranks());
  EXPECT_EQ(counts.here, ranks().count());
  EXPECT_EQ(counts.most, ranks().count());
}

}  // namespace
}  // namespace voxdag
