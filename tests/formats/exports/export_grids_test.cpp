// Facts that all voxel formats share.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <stdexcept>

#include "read_back.hpp"
#include "schematic.hpp"
#include "support/error_of.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/formats/exports/grids/export_binvox.hpp"
#include "voxdag/formats/exports/grids/export_playcanvas.hpp"
#include "voxdag/formats/exports/grids/export_schem.hpp"
#include "voxdag/formats/exports/grids/export_vdb.hpp"
#include "voxdag/formats/exports/grids/export_vox.hpp"

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

TEST(ExportGrids, FormatsThatAreCompletedAtTheirBeginningRefusePipes) {
  const TempDir dir;
  const ExportedScene scene(4, 10);
  const auto pipe = dir / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::string reason =
      pipe.string() + ": is a pipe, but this format is completed at its beginning: choose a file";
  EXPECT_EQ(error_of([&] { export_vox(pipe, scene.view(), scene.grid); }), reason);
  EXPECT_EQ(error_of([&] { export_vdb(pipe, scene.view(), scene.grid); }), reason);
  EXPECT_EQ(error_of([&] { export_ply_points(pipe, scene.view(), scene.grid); }), reason);
  EXPECT_EQ(error_of([&] { export_ply_faces(pipe, scene.view(), scene.grid); }), reason);
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
