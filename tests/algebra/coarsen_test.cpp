#include "voxdag/algebra/coarsen.hpp"

#include <gtest/gtest.h>

#include "support/brute_svdag.hpp"

namespace voxdag {
namespace {

TEST(Coarsen, IsTheDagOfTheCoarserVoxels) {
  for (int levels = 2; levels <= 8; ++levels)
    for (const int count : {0, 1, 50, 3000}) {
      const std::vector<Vec3i> voxels = random_voxels(levels, count, 11);
      const Svdag dag = brute_svdag(levels, voxels);
      for (int coarser = 2; coarser <= levels; ++coarser) {
        std::vector<Vec3i> cells;
        const int shift = levels - coarser;
        for (const Vec3i v : voxels) cells.push_back({v.x >> shift, v.y >> shift, v.z >> shift});
        EXPECT_EQ(coarsen(dag.view(), coarser), brute_svdag(coarser, cells))
            << levels << " levels to " << coarser;
      }
    }
}

}  // namespace
}  // namespace voxdag
