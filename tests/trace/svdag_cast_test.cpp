// Compares the cast at the paper's layout with the cast of all layouts.
#include "voxdag/trace/svdag_cast.hpp"

#include <gtest/gtest.h>

#include "support/same_cells.hpp"

namespace voxdag {
namespace {

SvdagNodes make_nodes(const SvdagView& dag) { return SvdagNodes(dag); }

TEST(SvdagCast, MeetsWhatThePlainCastMeets) {
  for (const int levels : {2, 3, 4, 5, 6, 7}) expect_same_cells(levels, 21, make_nodes, no_size);
}

TEST(SvdagCast, EndsAtTheSameLevelOfDetail) {
  for (const int levels : {2, 3, 5, 6}) expect_same_cells(levels, 22, make_nodes, some_size);
}

}  // namespace
}  // namespace voxdag
