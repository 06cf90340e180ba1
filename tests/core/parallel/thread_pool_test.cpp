#include "voxdag/core/parallel/thread_pool.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include "voxdag/core/parallel/ordered_pipeline.hpp"
#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/core/parallel/per_thread.hpp"
#include "voxdag/core/parallel/thread_count.hpp"

#ifdef VOXDAG_OWN_THREADS

namespace voxdag {
namespace {

TEST(ThreadPool, RunsLoopsInsideOfLoopsOnceForEachItem) {
  for (const std::size_t threads : {1, 2, 4, 7}) {
    const ThreadLimit limit(threads);
    std::vector<std::atomic<int>> calls(60 * 70);
    parallel_for(60, [&](std::size_t i) {
      parallel_for(70, 3, [&](std::size_t j) { ++calls[i * 70 + j]; });
    });
    for (const auto& count : calls) ASSERT_EQ(count, 1);
  }
}

TEST(ThreadPool, SeveralThreadsMayRunLoopsAtOnce) {
  const ThreadLimit limit(3);
  std::atomic<std::size_t> sum{0};
  std::vector<std::thread> callers;
  for (int caller = 0; caller < 4; ++caller)
    callers.emplace_back([&] {
      for (int repeat = 0; repeat < 50; ++repeat)
        parallel_for(100, 7, [&](std::size_t i) { sum += i; });
    });
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(sum, 4u * 50 * 4950);
}

TEST(ThreadPool, AnExceptionLeavesTheLoopThatItWasThrownIn) {
  const ThreadLimit limit(4);
  for (std::size_t bad = 0; bad < 50; ++bad) {
    std::atomic<int> caught{0};
    parallel_for(8, [&](std::size_t i) {
      try {
        parallel_for(50, [&](std::size_t j) {
          if (i % 2 == 1 && j == bad) throw std::runtime_error("bad");
        });
      } catch (const std::runtime_error&) {
        ++caught;
      }
    });
    EXPECT_EQ(caught, 4);
  }
}

TEST(ThreadPool, EachThreadHasAValueOfItsOwn) {
  const ThreadLimit limit(4);
  PerThread<std::size_t> counts([] { return std::size_t{0}; });
  parallel_for(10'000, 10, [&](std::size_t) { ++counts.local(); });
  EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), std::size_t{0}), 10'000u);
}

TEST(ThreadPool, PipelinesRunInsideOfLoops) {
  const ThreadLimit limit(4);
  std::vector<std::size_t> sums(20);
  parallel_for(sums.size(), [&](std::size_t k) {
    std::size_t next = 0;
    ordered_pipeline(
        200, 5, {},
        [&](std::size_t i) {
          std::atomic<std::size_t> items{0};
          parallel_for(10, [&](std::size_t) { ++items; });
          return i * items / 10;
        },
        [&](std::size_t i) {
          EXPECT_EQ(i, next++);
          sums[k] += i;
        });
  });
  for (const std::size_t sum : sums) EXPECT_EQ(sum, 199u * 100);
}

}  // namespace
}  // namespace voxdag

#endif
