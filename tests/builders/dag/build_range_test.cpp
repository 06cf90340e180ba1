#include <gtest/gtest.h>

#include <random>

#include "support/random_triangles.hpp"
#include "voxdag/algebra/combine.hpp"
#include "voxdag/builders/dag/build_methods.hpp"

namespace voxdag {
namespace {

CountedVector<QuantizedTriangle> random_triangles(int levels, int count) {
  std::mt19937_64 random(static_cast<unsigned>(levels));
  CountedVector<QuantizedTriangle> triangles;
  for (int i = 0; i < count; ++i) triangles.push_back(random_triangle(random, levels));
  return triangles;
}

TEST(CellRange, MeetsCellsOfAllLevels) {
  const CellRange range{2, 5, 9};
  for (std::uint32_t code = 0; code < 64; ++code)
    EXPECT_EQ(range.meets(2, code), code >= 5 && code < 9);
  for (std::uint32_t code = 0; code < 512; ++code)
    EXPECT_EQ(range.meets(3, code), code / 8 >= 5 && code / 8 < 9);
  EXPECT_TRUE(range.meets(1, 0));
  EXPECT_TRUE(range.meets(1, 1));
  EXPECT_FALSE(range.meets(1, 2));
  EXPECT_TRUE(range.meets(0, 0));
}

class BuildRange : public testing::TestWithParam<int> {};

TEST_P(BuildRange, PartsAreDisjointAndTheirUnionIsTheWhole) {
  const int levels = GetParam();
  const Svdag whole = build_range(random_triangles(levels, 40), levels, {});
  for (int level = 0; level <= std::min(levels - 2, 3); ++level) {
    const std::uint32_t cells = 1u << 3 * level, step = std::max(cells / 5, 1u);
    Svdag sum = build_range({}, levels, {level, 0, 0});
    EXPECT_TRUE(sum.view().is_empty());
    for (std::uint32_t first = 0; first < cells; first += step) {
      const CellRange range{level, first, std::min(first + step, cells)};
      const Svdag part = build_range(random_triangles(levels, 40), levels, range);
      EXPECT_TRUE(combine(sum.view(), part.view(), SetOperation::kIntersection).view().is_empty());
      sum = combine(sum.view(), part.view(), SetOperation::kUnion);
    }
    EXPECT_EQ(sum, whole) << level;
  }
}

INSTANTIATE_TEST_SUITE_P(Levels, BuildRange, testing::Values(2, 3, 4, 5, 7, 8));

}  // namespace
}  // namespace voxdag
