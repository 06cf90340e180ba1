#include "voxdag/cuda/launch_plan.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace voxdag {
namespace {

TEST(LaunchPlan, EverySampleOfEveryBlockComesOnceAndInOrder) {
  std::mt19937 rng(1);
  const auto up_to = [&](int n) { return 1 + static_cast<int>(rng() % static_cast<unsigned>(n)); };
  for (int round = 0; round < 200; ++round) {
    const auto blocks = static_cast<std::uint32_t>(up_to(300));
    const auto max_blocks = static_cast<std::uint32_t>(up_to(400));
    const int samples = up_to(20), max_samples = up_to(20);
    LaunchPlan plan(blocks, samples, up_to(5), up_to(3000), max_blocks, max_samples);
    std::vector<int> done(blocks, 0);
    double fraction = 0;
    while (const auto range = plan.next()) {
      ASSERT_LT(range->first_block, range->last_block);
      ASSERT_LE(range->last_block, blocks);
      ASSERT_LE(range->last_block - range->first_block, max_blocks);
      ASSERT_LE(range->last_sample - range->first_sample, max_samples);
      for (std::uint32_t block = range->first_block; block < range->last_block; ++block) {
        ASSERT_EQ(done[block], range->first_sample);
        done[block] = range->last_sample;
      }
      EXPECT_GT(plan.fraction(), fraction);
      fraction = plan.fraction();
      plan.measured(*range, 1e-3 * up_to(3000));
    }
    EXPECT_EQ(done, std::vector<int>(blocks, samples));
    EXPECT_EQ(fraction, 1);
  }
}

TEST(LaunchPlan, LaunchesFollowTheMeasuredSpeed) {
  // A device that does 1000 units of work per second. Launches are planned one ahead.
  LaunchPlan plan(1'000'000, 1, 1, 16, 1'000'000, 1);
  auto range = plan.next();
  for (int i = 0; i < 20; ++i) {
    const auto next = plan.next();
    plan.measured(*range, (range->last_block - range->first_block) / 1000.0);
    range = next;
  }
  EXPECT_NEAR(range->last_block - range->first_block, 200, 1);
}

TEST(LaunchPlan, OneSampleOfOneBlockIsTheSmallestLaunch) {
  LaunchPlan plan(3, 2, 100, 1, 100, 100);
  int pieces = 0;
  while (const auto range = plan.next()) {
    ++pieces;
    plan.measured(*range, 100);
  }
  EXPECT_EQ(pieces, 6);
}

}  // namespace
}  // namespace voxdag
