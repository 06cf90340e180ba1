// Tests lists of contours that share storage.
#include "voxdag/builders/esvo/encode/contour_pool.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace voxdag {
namespace {

std::vector<Contour> list_of(std::initializer_list<int> lows) {
  std::vector<Contour> list;
  for (const int low : lows) list.push_back(Contour::make({1, 2, 3}, low, 127));
  return list;
}

TEST(ContourPool, EqualListsAreStoredOnce) {
  ContourPool pool;
  const std::uint32_t first = pool.add(list_of({1, 2, 3}));
  EXPECT_EQ(pool.add(list_of({4, 1})), 3u);
  EXPECT_EQ(pool.add(list_of({1, 2, 3})), first);
  EXPECT_EQ(pool.contours().size(), 5u);
}

TEST(ContourPool, PartsOfListsNeedNoStorage) {
  ContourPool pool;
  pool.add(list_of({1, 2, 3, 4}));
  EXPECT_EQ(pool.add(list_of({2, 3})), 1u);
  EXPECT_EQ(pool.add(list_of({4})), 3u);
  EXPECT_EQ(pool.contours().size(), 4u);
  EXPECT_EQ(pool.add(list_of({3, 2})), 4u) << "another order is another list";
}

TEST(ContourPool, EveryListIsAtItsReturnedIndex) {
  std::mt19937 random(3);
  ContourPool pool;
  std::vector<std::pair<std::vector<Contour>, std::uint32_t>> added;
  std::size_t words = 0;
  for (int i = 0; i < 3000; ++i) {
    std::vector<Contour> list;
    const std::size_t count = 1 + random() % 8;
    while (list.size() < count)
      list.push_back(Contour::make({1, 0, 0}, static_cast<int>(random() % 4), 127));
    words += count;
    added.emplace_back(list, pool.add(list));
  }
  for (const auto& [list, place] : added) {
    ASSERT_LE(place + list.size(), pool.contours().size());
    EXPECT_TRUE(std::equal(list.begin(), list.end(), pool.contours().begin() + place));
  }
  EXPECT_LT(pool.contours().size(), words);
}

}  // namespace
}  // namespace voxdag
