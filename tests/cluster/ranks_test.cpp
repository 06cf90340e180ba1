/// What holds for any number of ranks. The tests run with one rank, and under mpirun with several:
/// then every rank runs every test, in one order.
#include "voxdag/cluster/ranks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <numeric>
#include <random>
#include <thread>

#include "ranks_under_test.hpp"
#include "shared_folder.hpp"

namespace voxdag {
namespace {

using Bytes = std::vector<std::byte>;

/// Returns the bytes that rank `from` sends to rank `to`: 0 to three and a half messages.
Bytes bytes_between(int from, int to) {
  std::minstd_rand random(static_cast<unsigned>(1 + from * 100 + to));
  constexpr std::size_t kSizes[] = {
      0, 1, kMessageBytes - 1, kMessageBytes, kMessageBytes + 1, 7 * kMessageBytes / 2};
  Bytes bytes(kSizes[(from * 3 + to) % std::size(kSizes)]);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
  return bytes;
}

TEST(Ranks, AllGatherReturnsTheValuesOfEveryRankInTheOrderOfRanks) {
  const std::uint64_t rank = ranks().rank(), large = (std::uint64_t{1} << 63) + rank;
  const std::vector<std::uint64_t> values = {rank, large, 5};
  std::vector<std::uint64_t> expected;
  for (int r = 0; r < ranks().count(); ++r)
    for (const std::uint64_t value :
         {std::uint64_t(r), (std::uint64_t{1} << 63) + r, std::uint64_t{5}})
      expected.push_back(value);
  EXPECT_EQ(ranks().all_gather(values), expected);
  EXPECT_TRUE(ranks().all_gather({}).empty());
}

TEST(Ranks, BroadcastGivesTheBytesOfRank0ToAll) {
  for (int other = 0; other < 6; ++other) {
    const Bytes expected = bytes_between(0, other);
    Bytes bytes = ranks().rank() == 0 ? expected : Bytes(17);
    ranks().broadcast(bytes);
    EXPECT_EQ(bytes, expected);
  }
}

TEST(Ranks, ExchangeDeliversMessagesOfAnySize) {
  const int me = ranks().rank(), count = ranks().count();
  std::vector<Bytes> outgoing, expected;
  std::uint64_t sent = 0;
  for (int r = 0; r < count; ++r) {
    outgoing.push_back(bytes_between(me, r));
    expected.push_back(bytes_between(r, me));
    if (r != me) sent += outgoing.back().size();
  }
  const std::uint64_t before = ranks().bytes_sent();
  EXPECT_EQ(ranks().exchange(std::move(outgoing)), expected);
  EXPECT_EQ(ranks().bytes_sent(), before + sent);
  EXPECT_EQ(ranks().exchange(std::vector<Bytes>(count)), std::vector<Bytes>(count));
}

/// Returns the numbers of all ranks, sorted. Every rank gives `numbers.size()`.
std::vector<std::uint64_t> sorted_of_all(const std::vector<std::uint64_t>& numbers) {
  std::vector<std::uint64_t> all = ranks().all_gather(numbers);
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<std::uint64_t> first_numbers(std::size_t count) {
  std::vector<std::uint64_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

TEST(Ranks, ACounterGivesEachNumberOnce) {
  constexpr int kCounter = 3, kDraws = 50;
  for (int round = 0; round < 2; ++round) {
    ranks().reset(kCounter);
    std::vector<std::uint64_t> numbers(kDraws);
    for (std::uint64_t& number : numbers) number = ranks().next(kCounter);
    EXPECT_TRUE(std::is_sorted(numbers.begin(), numbers.end()));
    EXPECT_EQ(sorted_of_all(numbers), first_numbers(std::size_t{kDraws} * ranks().count()));
  }
}

TEST(Ranks, ACounterServesTheThreadsOfARank) {
  constexpr int kCounter = 4, kDraws = 20;
  ranks().reset(kCounter);
  std::vector<std::uint64_t> numbers(2 * kDraws);
  const auto draw = [&](int thread) {
    for (int i = 0; i < kDraws; ++i) numbers[thread * kDraws + i] = ranks().next(kCounter);
  };
  std::thread other(draw, 1);
  draw(0);
  other.join();
  EXPECT_EQ(sorted_of_all(numbers), first_numbers(numbers.size() * ranks().count()));
}

TEST(Ranks, CountersAreIndependent) {
  ranks().reset(0);
  ranks().reset(Ranks::kCounters - 1);
  ranks().next(0);
  ranks().barrier();
  EXPECT_GE(ranks().next(0), 1u);
  EXPECT_LT(ranks().next(Ranks::kCounters - 1), static_cast<std::uint64_t>(ranks().count()));
}

/// Rank 0 is in no function of MPI until the others have drawn. If it had to be, none would end.
TEST(Ranks, ACounterWorksWhileRank0Computes) {
  constexpr int kCounter = 5, kDraws = 20;
  const SharedFolder folder(ranks());
  ranks().reset(kCounter);
  std::vector<std::uint64_t> numbers(kDraws);
  if (ranks().rank() == 0) {
    while (folder.count() < ranks().count() - 1)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  for (std::uint64_t& number : numbers) number = ranks().next(kCounter);
  if (ranks().rank() != 0) folder.touch("done." + std::to_string(ranks().rank()));
  if (ranks().rank() == 0) {
    EXPECT_EQ(numbers[0], static_cast<std::uint64_t>(kDraws) * (ranks().count() - 1));
  }
  EXPECT_EQ(sorted_of_all(numbers), first_numbers(std::size_t{kDraws} * ranks().count()));
}

}  // namespace
}  // namespace voxdag
