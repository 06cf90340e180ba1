#include "voxdag/builders/esvo/build/top_cells.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "support/displaced_crate.hpp"
#include "support/grid_mesh.hpp"
#include "voxdag/builders/esvo/build/open_edges.hpp"

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
      find_top_cells({grid, mesh, open_edges, &displaced, duplicates}, {}, nullptr, {});
  std::set<std::size_t> parents;
  for (std::size_t i = 1; i < cells.size(); ++i) parents.insert(cells[i].parent);
  int missed_by_all = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    EXPECT_NE(cells[i].is_task, parents.contains(i)) << i;
    missed_by_all += cells[i].is_task && cells[i].triangles.empty() ? 1 : 0;
  }
  EXPECT_GT(missed_by_all, 0);
}

TEST(TopCells, CellsWithTooManyTrianglesToLoadGetTheSameContours) {
  // A bumpy sheet with open edges and a hole.
  Mesh sheet = test::grid_mesh(60, [](int i, int j) {
    const float x = static_cast<float>(i) / 60, y = static_cast<float>(j) / 60;
    return Vec3f{100 + 1800 * x, 80 + 1850 * y, 1000 + 400 * std::sin(3 * x + 5 * y) + 90 * x * y};
  });
  sheet.triangles.erase(sheet.triangles.begin() + 2000, sheet.triangles.begin() + 2010);
  const Grid grid{11, {0, 0, 0}, 1.0, kSubvoxels};
  const QuantizedMesh mesh(sheet, grid);
  const IndexSet duplicates;
  const std::vector<std::uint8_t> open_edges = find_open_edges(mesh, duplicates);
  const TriangleSource source{grid, mesh, open_edges, nullptr, duplicates};
  EsvoSettings settings;
  settings.max_error = 0;  // Cells with too many triangles are never near the surface.
  const auto contours = [&](std::size_t most_loaded) {
    std::map<std::tuple<int, int, int, int>, std::uint32_t> result;
    for (const TopCell& cell : find_top_cells(source, settings, nullptr, {}, most_loaded))
      result[{cell.level, cell.cell.x, cell.cell.y, cell.cell.z}] =
          cell.decision.contour ? cell.decision.contour->bits : 0;
    return result;
  };
  const auto loaded = contours(kMaxLoaded);
  for (const std::size_t most_loaded : {40, 300}) {
    const auto streamed = contours(most_loaded);
    int with_contour = 0;
    for (const auto& [cell, contour] : loaded) {
      ASSERT_TRUE(streamed.contains(cell)) << most_loaded;
      EXPECT_EQ(streamed.at(cell), contour) << most_loaded << " level " << std::get<0>(cell);
      with_contour += contour != 0 ? 1 : 0;
    }
    EXPECT_GT(with_contour, 50);
  }
}

TEST(TopCells, CellsOfVeryManyTrianglesHaveContours) {
  const Mesh sheet = test::grid_mesh(300, [](int i, int j) {
    return Vec3f{static_cast<float>(i) * (250.0f / 300), static_cast<float>(j) * (250.0f / 300),
                 100 + 0.1f * static_cast<float>(i)};
  });
  const Grid grid{8, {0, 0, 0}, 1.0, kSubvoxels};
  const QuantizedMesh mesh(sheet, grid);
  const IndexSet duplicates;
  const std::vector<std::uint8_t> open_edges = find_open_edges(mesh, duplicates);
  const TopCells cells =
      find_top_cells({grid, mesh, open_edges, nullptr, duplicates}, {}, nullptr, {});
  int on_level_1 = 0;
  for (const TopCell& cell : cells) {
    if (cell.level != 1) continue;
    ++on_level_1;
    EXPECT_TRUE(cell.decision.contour.has_value());
  }
  EXPECT_GE(on_level_1, 4);
}

}  // namespace
}  // namespace voxdag
