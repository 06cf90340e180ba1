#include "voxdag/core/parallel/polled_sort.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "support/with_threads.hpp"

namespace voxdag {
namespace {

std::vector<std::uint64_t> random_values(std::size_t count) {
  std::mt19937_64 random(1);
  std::vector<std::uint64_t> values(count);
  std::generate(values.begin(), values.end(), std::ref(random));
  return values;
}

/// Sorts `values` on four threads.
template <class Less>
void sort(std::vector<std::uint64_t>& values, Work work, const Less& less) {
  with_threads(4, [&] { polled_sort(values.begin(), values.end(), work, less); });
}

TEST(PolledSort, SortsAsTheStandardLibraryDoes) {
  for (const std::size_t count : {0, 1, 2, 499, 500, 501, 100'000}) {
    std::vector<std::uint64_t> sorted = random_values(count), expected = sorted;
    sort(sorted, Work{}, std::greater<>());
    std::sort(expected.begin(), expected.end(), std::greater<>());
    EXPECT_EQ(sorted, expected) << count;
  }
}

TEST(PolledSort, StopsWhenCancelled) {
  std::vector<std::uint64_t> values = random_values(10'000);
  Progress progress;
  progress.cancel();
  EXPECT_THROW(sort(values, &progress, std::less<>()), Cancelled);
}

}  // namespace
}  // namespace voxdag
