// Compares the wide layout with the paper's: both must find the same cell for every ray.
#include "voxdag/trace/wide_cast.hpp"

#include <gtest/gtest.h>

#include "support/brute_svdag.hpp"
#include "support/same_cells.hpp"

namespace voxdag {
namespace {

/// Makes the wide layout of DAGs and owns the last one.
struct MakeWide {
  WideSvdag wide;
  WideNodes operator()(const SvdagView& dag) {
    wide = make_wide_svdag(dag);
    return WideNodes(wide.view());
  }
};

TEST(WideCast, MeetsWhatTheOctreeCastMeets) {
  for (const int levels : {2, 3, 4, 5, 6, 7}) expect_same_cells(levels, 11, MakeWide{}, no_size);
}

TEST(WideCast, EndsAtTheSameLevelOfDetail) {
  for (const int levels : {3, 5, 6}) expect_same_cells(levels, 12, MakeWide{}, some_size);
}

TEST(WideSvdag, HoldsEveryVoxelOnce) {
  const std::vector<Vec3i> voxels{{0, 0, 0}, {5, 1, 2}, {7, 7, 7}};
  const Svdag dag = brute_svdag(4, voxels);
  const WideSvdag wide = make_wide_svdag(dag.view());
  const WideNodes nodes(wide.view());
  EXPECT_EQ(wide.view().levels, 4);
  EXPECT_EQ(nodes.mask(nodes.root()), 1u | 1u << 1 | 1u << (1 + 4 + 16));
  const auto first = nodes.child(nodes.root(), nodes.mask(nodes.root()), 0);
  EXPECT_EQ(nodes.mask(first), 1u);
  const auto second = nodes.child(nodes.root(), nodes.mask(nodes.root()), 1);
  EXPECT_EQ(nodes.mask(second), std::uint64_t{1} << (1 + 4 * 1 + 16 * 2));
}

}  // namespace
}  // namespace voxdag
