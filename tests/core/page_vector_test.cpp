#include "voxdag/core/page_vector.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

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

TEST(LargeArray, KeepsItsValuesAtAnySize) {
  for (const std::size_t count : {0, 1, 1000, (1 << 19) - 1, 1 << 19, 1'500'000}) {
    const std::shared_ptr<std::uint32_t[]> array = make_large_array<std::uint32_t>(count);
    ASSERT_NE(array, nullptr);
    for (std::size_t i = 0; i < count; ++i) array[i] = static_cast<std::uint32_t>(i * 2654435761u);
    for (std::size_t i = 0; i < count; ++i)
      ASSERT_EQ(array[i], static_cast<std::uint32_t>(i * 2654435761u));
  }
}

TEST(LargeArray, RefusesSizesThatNoMachineHas) {
  constexpr std::size_t kMax = std::numeric_limits<std::size_t>::max();
  for (const std::size_t count : {kMax, kMax / 2, kMax / 4})
    EXPECT_THROW(make_large_array<std::uint32_t>(count), std::bad_alloc);
}

}  // namespace
}  // namespace voxdag
