// Compares walks by the path of the paper's layout with walks by the path of all layouts.
#include <gtest/gtest.h>

#include "support/same_cells.hpp"

namespace voxdag {
namespace {

SvdagNodes make_nodes(const SvdagView& dag) { return SvdagNodes(dag); }

TEST(SvdagPath, LeadsToTheSameCells) {
  for (const int levels : {2, 3, 4, 5, 6, 7}) expect_same_cells(levels, 21, make_nodes, no_size);
}

TEST(SvdagPath, EndsAtTheSameLevelOfDetail) {
  for (const int levels : {2, 3, 5, 6}) expect_same_cells(levels, 22, make_nodes, some_size);
}

}  // namespace
}  // namespace voxdag
