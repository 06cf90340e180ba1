#include "voxdag/trace/cell_blocks.hpp"

#include <gtest/gtest.h>

#include <set>
#include <tuple>

#include "support/brute_svdag.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {
namespace {

TEST(CellBlocks, HoldTheCellsOfEveryLevelAndNothingOutsideOfTheGrid) {
  for (const int levels : {2, 3, 6}) {
    const std::vector<Vec3i> voxels = random_voxels(levels, 20 << levels, 4);
    const Svdag dag = brute_svdag(levels, voxels);
    for (int level = 2; level <= levels; ++level) {
      std::set<std::tuple<int, int, int>> cells;
      const int shift = levels - level;
      for (const Vec3i v : voxels) cells.insert({v.x >> shift, v.y >> shift, v.z >> shift});
      const std::int32_t blocks_a_side = 1 << (level - 2);
      for (std::int32_t z = -2; z <= blocks_a_side; ++z)
        for (std::int32_t y = -2; y <= blocks_a_side; ++y)
          for (std::int32_t x = -2; x <= blocks_a_side; ++x) {
            const CellBlocks blocks = cell_blocks(SvdagNodes(dag.view()), level, {x, y, z});
            for (int b = 0; b < 8; ++b)
              for (std::uint32_t i = 0; i < 64; ++i) {
                const Vec3i block = Vec3i{x, y, z} + child_offset(b);
                const Vec3i cell = block * 4 + morton_decode(i);
                ASSERT_EQ(blocks.masks[b] >> i & 1u, cells.count({cell.x, cell.y, cell.z}));
              }
          }
    }
  }
}

TEST(CellBlocks, AreEmptyForAnEmptyDag) {
  const CellBlocks blocks = cell_blocks(SvdagNodes(Svdag{}.view()), 2, {0, 0, 0});
  for (const std::uint64_t mask : blocks.masks) EXPECT_EQ(mask, 0u);
}

}  // namespace
}  // namespace voxdag
