#include "voxdag/esvo/build/top_cells.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "support/displaced_crate.hpp"

namespace voxdag {
namespace {

TEST(TopCells, EveryCellIsATaskOrHasChildren) {
  // The volumes that enclose pieces of a slanted surface are larger for large cells than for small
  // ones. So some cells meet such a volume, but none of their children does.
  Crate crate;
  for (Vec3f& v : crate.mesh.vertices)
    v = {0.6f * v.x - 0.8f * v.y, 0.48f * v.x + 0.36f * v.y - 0.8f * v.z,
         0.64f * v.x + 0.48f * v.y + 0.6f * v.z};
  const DisplacedTriangles displaced(crate.mesh, crate.appearance,
                                     {{stones(), -0.1, 0.3, {}, 0}, Displacement{}});
  Grid grid;
  grid.origin = {-1.5, -1.5, -0.5};
  grid.levels = 10;
  grid.voxel_size = std::ldexp(4.0, -grid.levels);
  grid.quantization_scale = kSubvoxels / grid.voxel_size;
  const QuantizedMesh mesh(crate.mesh, grid);
  const std::vector<std::uint8_t> open_edges(crate.mesh.triangles.size());
  const IndexSet duplicates;
  const TopCells cells =
      find_top_cells({grid, mesh, open_edges, &displaced, duplicates}, {}, nullptr, nullptr);
  std::set<std::size_t> parents;
  for (std::size_t i = 1; i < cells.size(); ++i) parents.insert(cells[i].parent);
  int missed_by_all = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    EXPECT_NE(cells[i].is_task, parents.contains(i)) << i;
    missed_by_all += cells[i].is_task && cells[i].triangles.empty() ? 1 : 0;
  }
  EXPECT_GT(missed_by_all, 0);
}

}  // namespace
}  // namespace voxdag
