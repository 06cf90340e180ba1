#include "voxdag/core/large_array.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

namespace voxdag {
namespace {

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
  constexpr std::size_t kMost = std::numeric_limits<std::size_t>::max();
  for (const std::size_t count : {kMost, kMost / 2, kMost / 4})
    EXPECT_THROW(make_large_array<std::uint32_t>(count), std::bad_alloc);
}

}  // namespace
}  // namespace voxdag
