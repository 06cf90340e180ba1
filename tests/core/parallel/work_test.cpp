#include "voxdag/core/parallel/work.hpp"

#include <gtest/gtest.h>

#include <string>

namespace voxdag {
namespace {

TEST(Work, WithoutBudgetAndProgressCanAlwaysGoOn) {
  const Work work;
  EXPECT_EQ(work.memory, nullptr);
  EXPECT_FALSE(work.cancelled());
  work.poll();
  work.report("stage", 0.5);
  work.report_done("stage", 1, 2);
}

TEST(Work, IsCancelledWithItsProgress) {
  Progress progress;
  const Work work = &progress;
  work.poll();
  progress.cancel();
  EXPECT_TRUE(work.cancelled());
  EXPECT_THROW(work.poll(), Cancelled);
  EXPECT_THROW(work.poll_seldom(65536), Cancelled);
  work.poll_seldom(65535);
}

TEST(Work, ReportsToItsProgress) {
  std::string reports;
  Progress progress([&](std::string_view stage, double fraction, std::uint64_t items) {
    reports +=
        std::string(stage) + " " + std::to_string(fraction) + " " + std::to_string(items) + "; ";
  });
  MemoryBudget budget;
  const Work work(&budget, &progress);
  work.report("a", 0.25);
  work.report("b", 0.5, 7);
  work.report_done("c", 3, 4);
  EXPECT_EQ(reports, "a 0.250000 0; b 0.500000 7; c 0.750000 3; ");
}

}  // namespace
}  // namespace voxdag
