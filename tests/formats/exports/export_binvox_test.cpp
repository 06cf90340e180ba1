#include "voxdag/formats/exports/grids/export_binvox.hpp"

#include <gtest/gtest.h>

#include "read_back.hpp"
#include "support/temp_dir.hpp"

namespace voxdag {
namespace {

TEST(ExportBinvox, IsReadBack) {
  const TempDir dir;
  const ExportedScene scene(5, 2000);
  export_binvox(dir / "v.binvox", scene.view(), scene.grid);
  EXPECT_EQ(read_back(dir / "v.binvox"), voxels_of(scene, whole_grid(5)));
  const auto grid = open_voxel_source(dir / "v.binvox")->grid();
  EXPECT_EQ(grid->origin, scene.grid.origin);
  EXPECT_EQ(grid->voxel_size, scene.grid.voxel_size);
  EXPECT_EQ(grid->levels, 5);

  export_binvox(dir / "w.binvox", scene.view(), scene.grid, windowed(kWindow.lo, kWindow.hi));
  EXPECT_TRUE(read_text(dir / "w.binvox").starts_with("#binvox 1\ndim 31 31 31\ntranslate "));
  EXPECT_EQ(read_back(dir / "w.binvox", kWindow.lo), voxels_of(scene, kWindow));
}

}  // namespace
}  // namespace voxdag
