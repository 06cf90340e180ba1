#include <gtest/gtest.h>

#include <map>

#include "support/brute_svdag.hpp"
#include "support/error_of.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"
#include "voxdag/stored/attributes/cell_index_lookup.hpp"
#include "voxdag/stored/svdag/svdag_lookup.hpp"

namespace voxdag {
namespace {

/// The numbers of all cells of levels 0 to `finest`, by level and Morton code.
using Numbers = std::map<std::pair<int, std::uint64_t>, std::uint64_t>;

/// Numbers the cells by their place in a sorted list: a cell stands where its first voxel stands,
/// parents before children.
Numbers brute_numbers(int levels, int finest, const std::vector<Vec3i>& voxels) {
  std::map<std::pair<std::uint64_t, int>, std::uint64_t> order;
  for (const Vec3i voxel : voxels)
    for (int level = 0; level <= finest; ++level) {
      const int shift = 3 * (levels - level);
      order[{morton_encode(voxel) >> shift << shift, level}] = 0;
    }
  Numbers numbers;
  for (const auto& [key, unused] : order)
    numbers.emplace(std::pair(key.second, key.first >> (3 * (levels - key.second))),
                    numbers.size());
  return numbers;
}

TEST(CellIndex, EveryCellHasItsPlaceInDepthFirstOrder) {
  for (int levels = 2; levels <= 6; ++levels)
    for (const NamedVoxels& set : voxel_sets(levels, 7)) {
      const Svdag dag = brute_svdag(levels, set.voxels);
      for (int finest = 0; finest <= levels; ++finest) {
        const CellIndex index = build_cell_index(dag.view(), finest);
        const Numbers numbers = brute_numbers(levels, finest, set.voxels);
        ASSERT_EQ(index.cells, numbers.size())
            << set.name << ", levels " << levels << ", finest " << finest;
        for (const auto& [cell, expected] : numbers) {
          std::uint64_t number = ~std::uint64_t{0};
          ASSERT_TRUE(find_cell_number(dag.view(), index.view(), morton_decode(cell.second),
                                       cell.first, number));
          ASSERT_EQ(number, expected)
              << set.name << ", level " << cell.first << " of " << levels << ", finest " << finest;
        }
      }
    }
}

TEST(CellIndex, CellsBelowTheFinestLevelHaveTheNumberOfTheirAncestor) {
  const int levels = 6;
  const std::vector<Vec3i> voxels = random_voxels(levels, 500, 3);
  const Svdag dag = brute_svdag(levels, voxels);
  for (int finest = 0; finest < levels; ++finest) {
    const CellIndex index = build_cell_index(dag.view(), finest);
    const Numbers numbers = brute_numbers(levels, finest, voxels);
    for (const Vec3i voxel : voxels)
      for (int level = finest + 1; level <= levels; ++level) {
        std::uint64_t number = 0;
        const std::uint64_t code = morton_encode(voxel);
        ASSERT_TRUE(find_cell_number(dag.view(), index.view(),
                                     morton_decode(code >> (3 * (levels - level))), level, number));
        ASSERT_EQ(number, numbers.at({finest, code >> (3 * (levels - finest))}));
      }
  }
}

TEST(CellIndex, CellsWithoutVoxelsHaveNoNumber) {
  const int levels = 5;
  const std::vector<Vec3i> voxels = random_voxels(levels, 300, 4);
  const Svdag dag = brute_svdag(levels, voxels);
  const CellIndex index = build_cell_index(dag.view(), levels);
  for (const Vec3i cell : voxels_where(levels, [](Vec3i) { return true; })) {
    std::uint64_t number = 0;
    ASSERT_EQ(find_cell_number(dag.view(), index.view(), cell, levels, number),
              svdag_contains(dag.view(), cell, levels));
  }
  std::uint64_t number = 0;
  EXPECT_FALSE(find_cell_number(dag.view(), index.view(), {-1, 0, 0}, levels, number));
  EXPECT_FALSE(find_cell_number(dag.view(), index.view(), {0, 32, 0}, levels, number));
}

TEST(CellIndex, TheNumbersThatWereBuiltAreValid) {
  for (int levels = 2; levels <= 6; ++levels)
    for (const NamedVoxels& set : voxel_sets(levels, 8)) {
      const Svdag dag = brute_svdag(levels, set.voxels);
      for (int finest = 0; finest <= levels; ++finest)
        EXPECT_NO_THROW(
            validate_cell_index(dag.view(), build_cell_index(dag.view(), finest).view()));
    }
}

TEST(CellIndex, CountsItsMemoryWhileItIsBuilt) {
  const Svdag dag = brute_svdag(6, random_voxels(6, 500, 9));
  MemoryBudget budget;
  const CellIndex index = build_cell_index(dag.view(), 6, &budget);
  EXPECT_GE(budget.peak(), index.view().bytes());
  EXPECT_LE(budget.peak(), 2 * index.view().bytes());
  EXPECT_EQ(budget.used(), 0u);
  MemoryBudget small(index.view().bytes() / 2);
  EXPECT_THROW(build_cell_index(dag.view(), 6, &small), OverMemory);
  EXPECT_EQ(small.used(), 0u);
}

TEST(CellIndex, EveryFlippedBitIsRefused) {
  const int levels = 5;
  const Svdag dag = brute_svdag(levels, random_voxels(levels, 60, 5));
  CellIndex index = build_cell_index(dag.view(), levels);
  ASSERT_GT(index.words.size(), 4u);
  for (std::size_t bit = 0; bit < 64 * index.words.size(); ++bit) {
    index.words[bit / 64] ^= std::uint64_t{1} << bit % 64;
    EXPECT_NE(error_of([&] { validate_cell_index(dag.view(), index.view()); }), "no error") << bit;
    index.words[bit / 64] ^= std::uint64_t{1} << bit % 64;
  }
}

TEST(CellIndex, AnotherLevelWidthOrNumberOfCellsIsRefused) {
  const Svdag dag = brute_svdag(5, random_voxels(5, 60, 6));
  const CellIndex index = build_cell_index(dag.view(), 5);
  const auto refused = [&](const auto& change) {
    CellIndexView view = index.view();
    change(view);
    EXPECT_NE(error_of([&] { validate_cell_index(dag.view(), view); }), "no error");
  };
  refused([](CellIndexView& view) { ++view.cells; });
  refused([](CellIndexView& view) { --view.finest_level; });
  refused([](CellIndexView& view) { view.finest_level = 6; });
  refused([](CellIndexView& view) { ++view.width[0]; });
  refused([](CellIndexView& view) { view.width[0] = 0; });
  refused([](CellIndexView& view) { view.width[0] = 65; });
  refused([](CellIndexView& view) { view.width[3] = 1; });
  refused([](CellIndexView& view) { ++view.begin[1]; });
  refused([](CellIndexView& view) { --view.begin[kMaxLevels]; });
}

/// A DAG of a full grid has one node per level, so that 2^60 voxels need few words.
TEST(CellIndex, CountsTheCellsOfAFullGridOfTheGreatestResolution) {
  Svdag dag;
  dag.levels = kMaxLevels;
  dag.leaf_blocks = {~std::uint64_t{0}};
  for (int level = 0; level < kMaxLevels - 2; ++level) {
    dag.level_begin[static_cast<std::size_t>(level)] = dag.nodes.size();
    const auto child =
        level + 1 == kMaxLevels - 2 ? 0u : static_cast<std::uint32_t>(dag.nodes.size() + 9);
    dag.nodes.push_back(0xFF);
    dag.nodes.insert(dag.nodes.end(), 8, child);
  }
  for (std::size_t level = kMaxLevels - 2; level <= kMaxLevels; ++level)
    dag.level_begin[level] = dag.nodes.size();
  const CellIndex index = build_cell_index(dag.view(), kMaxLevels);
  std::uint64_t cells = 0;
  for (int level = 0; level <= kMaxLevels; ++level) cells += std::uint64_t{1} << 3 * level;
  EXPECT_EQ(index.cells, cells);
  EXPECT_NO_THROW(validate_cell_index(dag.view(), index.view()));
  const std::int32_t last = (1 << kMaxLevels) - 1;
  std::uint64_t number = 0;
  ASSERT_TRUE(find_cell_number(dag.view(), index.view(), {last, last, last}, kMaxLevels, number));
  EXPECT_EQ(number, cells - 1);
}

}  // namespace
}  // namespace voxdag
