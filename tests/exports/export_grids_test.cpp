// Facts that all voxel formats share.
#include <gtest/gtest.h>

#include <stdexcept>

#include "read_back.hpp"
#include "schematic.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/exports/grids/export_binvox.hpp"
#include "voxdag/exports/grids/export_playcanvas.hpp"
#include "voxdag/exports/grids/export_schem.hpp"
#include "voxdag/exports/grids/export_vox.hpp"

namespace voxdag {
namespace {

TEST(ExportGrids, CancellingLeavesNothing) {
  const TempDir dir;
  const ColoredScene scene(6);
  ExportOptions options = scene.options;
  options.progress = [](double, std::uint64_t) { throw std::runtime_error("stop"); };
  EXPECT_ANY_THROW(export_vox(dir / "v.vox", scene.view(), scene.grid, options));
  EXPECT_ANY_THROW(export_binvox(dir / "v.binvox", scene.view(), scene.grid, options));
  EXPECT_ANY_THROW(export_schem(dir / "v.schem", scene.view(), scene.grid, options));
  EXPECT_ANY_THROW(export_playcanvas(dir / "v.voxel.json", scene.view(), scene.grid, options));
  EXPECT_EQ(dir.count(), 0);
}

TEST(ExportGrids, AnEmptyDagMakesFilesWithoutVoxels) {
  const TempDir dir;
  const ExportedScene scene(4, 0);
  export_vox(dir / "v.vox", scene.view(), scene.grid);
  export_binvox(dir / "v.binvox", scene.view(), scene.grid);
  export_schem(dir / "v.schem", scene.view(), scene.grid);
  EXPECT_TRUE(read_back(dir / "v.vox").empty());
  EXPECT_TRUE(read_back(dir / "v.binvox").empty());
  EXPECT_EQ(Nbt(unzipped(dir / "v.schem")).blocks, std::string(16 * 16 * 16, '\0'));
}

}  // namespace
}  // namespace voxdag
