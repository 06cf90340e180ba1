#include "voxdag/core/memory_budget.hpp"

#include <gtest/gtest.h>

namespace voxdag {
namespace {

TEST(MemoryBudget, ReservesUpToItsLimitAndNotBeyond) {
  MemoryBudget budget(100, 20);
  budget.reserve(80);
  EXPECT_EQ(budget.left(), 0u);
  EXPECT_THROW(budget.reserve(1), OverMemory);
  EXPECT_EQ(budget.used(), 80u);
  EXPECT_TRUE(budget.exceeded());
  budget.release(80);
  EXPECT_EQ(budget.left(), 80u);
  EXPECT_EQ(budget.peak(), 80u);
}

TEST(MemoryBudget, ErrorNamesTheLimitAndTheNeed) {
  const MemoryBudget budget(std::uint64_t{64} << 20);
  try {
    budget.throw_over_memory((std::uint64_t{80} << 20) + 1);
    FAIL();
  } catch (const OverMemory& error) {
    EXPECT_STREQ(error.what(),
                 "the memory limit of 64 MiB is too small: at least 81 MiB are needed");
  }
}

TEST(MemoryReservation, ReleasesWhatItHolds) {
  MemoryBudget budget(100);
  {
    MemoryReservation a(&budget, 60);
    a.resize(90);
    EXPECT_EQ(budget.used(), 90u);
    MemoryReservation b = std::move(a);
    b.resize(10);
    EXPECT_EQ(budget.used(), 10u);
    EXPECT_THROW(b.resize(200), OverMemory);
    EXPECT_EQ(b.bytes(), 10u);
  }
  EXPECT_EQ(budget.used(), 0u);
}

TEST(CountedVector, CountsItsCapacityAndStopsAtTheLimit) {
  MemoryBudget budget(1000);
  {
    CountedVector<int> values{CountedAllocator<int>(&budget)};
    values.reserve(100);
    EXPECT_EQ(budget.used(), 400u);
    EXPECT_THROW(values.reserve(200),
                 OverMemory);  // the old and the new array exist at the same time
    EXPECT_EQ(budget.used(), 400u);
    CountedVector<int> moved = std::move(values);
    EXPECT_EQ(budget.used(), 400u);
  }
  EXPECT_EQ(budget.used(), 0u);
}

}  // namespace
}  // namespace voxdag
