#include "voxdag/stored/attributes/coarsen_attributes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/brute_svdag.hpp"
#include "support/number_colors.hpp"
#include "voxdag/algebra/coarsen.hpp"
#include "voxdag/stored/attributes/look.hpp"

namespace voxdag {
namespace {

/// Expects that each cell of the coarse grid has the values that it has in the fine grid.
void expect_kept(const ColoredDagView& fine, int levels) {
  const Svdag coarse = coarsen(fine.dag, levels);
  const DagAttributes attributes = coarsen_attributes(fine, coarse.view());
  const ColoredDagView colored{coarse.view(), attributes.view()};
  const int finest = std::min<int>(levels, fine.attributes.index.finest_level);
  ASSERT_EQ(attributes.index, build_cell_index(coarse.view(), finest));
  std::uint64_t cells = 0;
  for (int level = 0; level <= finest; ++level)
    for (std::uint64_t code = 0; code < std::uint64_t{1} << 3 * level; ++code) {
      const Vec3i cell = morton_decode(code);
      std::uint64_t before = 0, after = 0;
      const bool exists = find_number(fine, cell, level, before);
      ASSERT_EQ(find_number(colored, cell, level, after), exists);
      if (!exists) continue;
      ++cells;
      ASSERT_EQ(read_value(attributes.colors.view(), after), color_of_number(before));
      ASSERT_EQ(read_value(attributes.normals.view(), after), color_of_number(before));
      ASSERT_EQ(read_material(attributes.materials.view(), after), material_of_number(before));
    }
  EXPECT_EQ(cells, attributes.index.cells);
}

TEST(CoarsenAttributes, EveryCellKeepsItsValues) {
  const Svdag dag = brute_svdag(6, random_voxels(6, 3000, 4));
  for (int finest = 0; finest <= 6; ++finest) {
    const NumberColors colors(dag.view(), finest);
    for (int levels = 2; levels <= 6; ++levels) expect_kept(colors.view(), levels);
  }
}

TEST(CoarsenAttributes, BoundsLimitTheChange) {
  const Svdag dag = brute_svdag(6, random_voxels(6, 3000, 4)), coarse = coarsen(dag.view(), 5);
  const NumberColors colors(dag.view(), 6);
  const ColoredDagView fine = colors.view();
  const CoarsenBounds bounds{0.1, 10};
  const DagAttributes attributes = coarsen_attributes(fine, coarse.view(), bounds);
  EXPECT_LT(attributes.colors.words.size(),
            coarsen_attributes(fine, coarse.view()).colors.words.size());
  for (std::uint64_t code = 0; code < std::uint64_t{1} << 15; ++code) {
    const Vec3i cell = morton_decode(code);
    std::uint64_t before = 0, after = 0;
    if (!find_number(fine, cell, 5, before)) continue;
    ASSERT_TRUE(find_number({coarse.view(), attributes.view()}, cell, 5, after));
    const Value8 a = color_of_number(before), b = read_value(attributes.colors.view(), after);
    double sum = 0;
    for (int c = 0; c < 3; ++c)
      sum += kColorWeights[static_cast<std::size_t>(c)] * std::pow(a[c] - b[c], 2);
    ASSERT_LE(std::sqrt(sum / 7), 255 * 0.1 + 1e-9);
  }
}

TEST(CoarsenAttributes, MissingKindsStayMissing) {
  const Svdag dag = brute_svdag(6, random_voxels(6, 100, 4)), coarse = coarsen(dag.view(), 3);
  const NumberColors colors(dag.view(), 6);
  ColoredDagView fine = colors.view();
  fine.attributes.normals = {};
  fine.attributes.materials = {};
  const DagAttributes attributes = coarsen_attributes(fine, coarse.view());
  EXPECT_TRUE(attributes.view().has_colors());
  EXPECT_FALSE(attributes.view().has_normals());
  EXPECT_FALSE(attributes.view().has_materials());
}

TEST(CoarsenAttributes, MemoryIsCountedAndReleased) {
  const Svdag dag = brute_svdag(7, random_voxels(7, 20000, 4)), coarse = coarsen(dag.view(), 6);
  const NumberColors colors(dag.view(), 7);
  MemoryBudget budget(std::uint64_t{1} << 30);
  coarsen_attributes(colors.view(), coarse.view(), {}, &budget);
  EXPECT_GT(budget.peak(), 100'000u);
  EXPECT_EQ(budget.used(), 0u);
  MemoryBudget small(10'000);
  EXPECT_THROW(coarsen_attributes(colors.view(), coarse.view(), {}, &small), OverMemory);
  EXPECT_EQ(small.used(), 0u);
}

}  // namespace
}  // namespace voxdag
