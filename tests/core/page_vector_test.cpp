#include "voxdag/core/page_vector.hpp"

#include <gtest/gtest.h>

namespace voxdag {
namespace {

TEST(PageVector, KeepsItsElementsWhileItGrows) {
  PageVector<std::uint64_t> values;
  for (std::uint64_t i = 0; i < 1'000'000; ++i) values.push_back(i * i);
  ASSERT_EQ(values.size(), 1'000'000u);
  for (std::uint64_t i = 0; i < values.size(); ++i) ASSERT_EQ(values[i], i * i);
  PageVector<std::uint64_t> moved = std::move(values);
  EXPECT_EQ(moved[999], 999u * 999u);
}

TEST(PageVector, NewMemoryIsZero) {
  PageVector<int> values;
  values.resize(5000);
  for (const int value : values) ASSERT_EQ(value, 0);
}

TEST(PageVector, CountsItsPagesAndStopsAtTheLimit) {
  MemoryBudget budget(std::uint64_t{1} << 20);
  {
    PageVector<int> values(&budget);
    values.push_back(7);
    EXPECT_EQ(budget.used(), 4096u);
    values.resize(10000);
    EXPECT_EQ(budget.used(), values.bytes());
    EXPECT_THROW(values.resize(1 << 20), OverMemory);
    EXPECT_EQ(values.size(), 10000u);
    EXPECT_EQ(values[0], 7);
    values.resize(1024);
    values.shrink_to_fit();
    EXPECT_EQ(budget.used(), 4096u);
  }
  EXPECT_EQ(budget.used(), 0u);
}

}  // namespace
}  // namespace voxdag
