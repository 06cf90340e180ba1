// Three edges at a time against one at a time.
#include "voxdag/esvo/small_triangle.hpp"

#include <gtest/gtest.h>

#include <random>

#include "support/random_triangles.hpp"

namespace voxdag {
namespace {

TEST(SmallTriangle, IsClassifiedAsAnyOther) {
  std::mt19937_64 random(5);
  constexpr int kRounds = 200000;
  int small = 0, compared = 0;
  for (int round = 0; round < kRounds; ++round) {
    const int levels = 1 + static_cast<int>(random() % 8);
    const TriangleSetup setup = make_triangle_setup(random_triangle(random, levels), {});
    if (!has_small_edges(setup, levels)) continue;
    ++small;
    // A random way from the root down.
    std::uint32_t conditions = setup.conditions;
    Vec3i cell{};
    for (int half = 1 << (levels - 1); half > 0; half /= 2) {
      const ChildConditions expected = classify_children(setup, conditions, cell, half);
      const ChildConditions found = classify_small_children(setup, conditions, cell, half);
      ASSERT_EQ(found.alive, expected.alive);
      for (int child = 0; child < 8; ++child) {
        if (half == 1 || (expected.alive >> child & 1u) == 0) continue;
        ASSERT_EQ(found.conditions(child), expected.conditions(child));
      }
      ++compared;
      if (expected.alive == 0) break;
      int child = static_cast<int>(random() % 8);
      while ((expected.alive >> child & 1u) == 0) child = (child + 1) % 8;
      conditions = expected.conditions(child);
      cell = cell + Vec3i{child & 1, child >> 1 & 1, child >> 2} * half;
    }
  }
  EXPECT_GT(small, kRounds / 2);
  EXPECT_GT(compared, kRounds);
}

TEST(SmallTriangle, IsNoneWhereFloatsWouldRound) {
  // An edge function of 2^24 or more within the cell.
  const QuantizedTriangle large{{0, 0, 0}, {1 << 17, 3, 5}, {7, 1 << 17, 1 << 16}};
  EXPECT_FALSE(has_small_edges(make_triangle_setup(large, {}), 9));
  const QuantizedTriangle far{
      {1 << 24, 1 << 24, 0}, {(1 << 24) + 300, 1 << 24, 7}, {1 << 24, (1 << 24) + 200, 300}};
  EXPECT_FALSE(has_small_edges(make_triangle_setup(far, {}), 17));
  EXPECT_TRUE(has_small_edges(make_triangle_setup(far, {1 << 16, 1 << 16, 0}), 4));
}

}  // namespace
}  // namespace voxdag
