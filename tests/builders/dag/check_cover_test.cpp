#include "voxdag/builders/dag/check_cover.hpp"

#include <gtest/gtest.h>

#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"

namespace voxdag {
namespace {

Mesh pyramid() {
  return {{{0, 0, 0}, {1, 0, 0.1f}, {0.9f, 0.1f, 1}, {0, 0, 0.8f}, {0.4f, 0.9f, 0.5f}},
          {{0, 1, 2}, {0, 2, 3}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}},
          {},
          {}};
}

TEST(CheckCover, AGoodDagHasNoMismatch) {
  const Mesh mesh = pyramid();
  for (const int levels : {2, 5, 10, 16}) {
    const Grid grid = fit_grid(mesh, levels);
    const CoverCheck check = check_cover(build_svdag(mesh, grid).dag.view(), grid, mesh, 20000);
    EXPECT_EQ(check.samples, 20000u);
    EXPECT_EQ(check.mismatches, 0u) << levels << " levels";
    EXPECT_GT(check.covered, 3000u);
    if (levels > 2) {
      EXPECT_LT(check.covered, 19000u);
    }
  }
}

TEST(CheckCover, FindsOneWrongVoxelInALeafBlockThatManyShare) {
  const Mesh mesh = pyramid();
  const Grid grid = fit_grid(mesh, 8);
  Svdag dag = build_svdag(mesh, grid).dag;
  dag.leaf_blocks[0] ^= std::uint64_t{1} << 63;
  dag.leaf_blocks[dag.leaf_blocks.size() / 2] ^= 1;
  EXPECT_GT(check_cover(dag.view(), grid, mesh, 100000).mismatches, 0u);
}

TEST(CheckCover, RefusesAGridOfAnotherResolution) {
  const Mesh mesh = pyramid();
  const Svdag dag = build_svdag(mesh, fit_grid(mesh, 6)).dag;
  EXPECT_THROW(check_cover(dag.view(), fit_grid(mesh, 7), mesh, 10), Error);
}

}  // namespace
}  // namespace voxdag
