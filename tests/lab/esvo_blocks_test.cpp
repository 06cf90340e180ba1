#include "lab/attributes/esvo_blocks.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"
#include "voxdag/stored/attributes/cell_index_lookup.hpp"

namespace voxdag::lab {
namespace {

/// A slanted square: its DAG shares nodes.
Svdag slanted(int levels) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0.3f}, {1, 1, 0.9f}, {0, 1, 0.6f}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return build_svdag(mesh, fit_grid(mesh, levels), {}).dag;
}

/// Counts blocks by the children of each cell, found by their places.
std::uint64_t count_blocks(const SvdagView& dag, const CellIndexView& index, Vec3i cell,
                           int level) {
  if (level + 1 >= index.finest_level) return 0;
  std::uint64_t children = 0, blocks = 0;
  for (int child = 0; child < 8; ++child) {
    const Vec3i place = cell * 2 + child_offset(child);
    std::uint64_t number = 0;
    if (!find_cell_number(dag, index, place, level + 1, number)) continue;
    ++children;
    blocks += count_blocks(dag, index, place, level + 1);
  }
  return blocks + (children + 1) / 2;
}

TEST(EsvoBlocks, ArePairsOfSiblings) {
  for (const int levels : {2, 3, 5, 8}) {
    const Svdag dag = slanted(levels);
    const CellIndex index = build_cell_index(dag.view(), levels);
    const std::vector<Value8> grey(index.cells, Value8{0, 255, 0});
    const EsvoColors encoded = encode_esvo_colors(dag.view(), index.view(), grey, Progress());
    EXPECT_EQ(encoded.blocks, 1 + count_blocks(dag.view(), index.view(), {}, 0)) << levels;
    EXPECT_EQ(encoded.colors, grey) << levels;
  }
}

TEST(EsvoBlocks, EveryCellGetsAColourNearItsOwn) {
  const Svdag dag = slanted(7);
  const CellIndex index = build_cell_index(dag.view(), 7);
  std::vector<Value8> colors(index.cells);
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const auto grey = static_cast<std::uint8_t>(i / 3 % 256);
    colors[i] = {grey, grey, grey};
  }
  const EsvoColors encoded = encode_esvo_colors(dag.view(), index.view(), colors, Progress());
  ASSERT_EQ(encoded.colors.size(), colors.size());
  double sum = 0;
  for (std::size_t i = 0; i < colors.size(); ++i)
    sum += std::abs(int{encoded.colors[i].y} - int{colors[i].y});
  // Numbers of cells in a block are near each other, and so are these colours: four levels between
  // two ends.
  EXPECT_LT(sum / static_cast<double>(colors.size()), 20);
}

}  // namespace
}  // namespace voxdag::lab
