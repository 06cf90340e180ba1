#include "voxdag/formats/exports/grids/export_slices.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "read_back.hpp"
#include "support/error_of.hpp"
#include "support/temp_dir.hpp"

namespace voxdag {
namespace {

TEST(ExportSlices, AreReadBack) {
  const TempDir dir;
  const ExportedScene scene(5, 2000);
  export_slices(dir / "grey", 2, scene.view(), scene.grid, windowed(kWindow.lo, kWindow.hi));
  EXPECT_EQ(read_back(dir / "grey", kWindow.lo), voxels_of(scene, kWindow));
  EXPECT_TRUE(std::filesystem::exists(dir / "grey/slice_0006.png"));
  EXPECT_FALSE(std::filesystem::exists(dir / "grey/slice_0007.png"));
  const nlohmann::json placement = nlohmann::json::parse(read_text(dir / "grey/placement.json"));
  EXPECT_EQ(placement["window"]["lo"], nlohmann::json({3, 1, 6}));
  EXPECT_EQ(placement["array"]["axes_slowest_to_fastest"], "zyx");

  const ColoredScene colored(6);
  export_slices(dir / "colored", 2, colored.view(), colored.grid, colored.options);
  EXPECT_EQ(read_back(dir / "colored"), colored_voxels_of(colored, whole_grid(6)));
}

TEST(ExportSlices, OfOtherAxesTurnTheVoxels) {
  const TempDir dir;
  const ExportedScene scene(4, 300);
  for (int axis = 0; axis < 2; ++axis) {
    const auto folder = dir / std::to_string(axis);
    export_slices(folder, axis, scene.view(), scene.grid);
    ColoredVoxels turned;
    for (const Vec3i v : scene.voxels)
      turned[axis == 0 ? VoxelKey{v.y, v.z, v.x} : VoxelKey{v.x, v.z, v.y}] = {};
    EXPECT_EQ(read_back(folder), turned);
  }
}

TEST(ExportSlices, TheFolderIsCompleteOrNotThere) {
  const TempDir dir;
  const ExportedScene scene(4, 300);
  ExportOptions options;
  int calls = 0;
  options.progress = [&](double, std::uint64_t) {
    if (++calls == 5) throw std::runtime_error("stop");
  };
  EXPECT_THROW(export_slices(dir / "s", 2, scene.view(), scene.grid, options), std::runtime_error);
  EXPECT_EQ(dir.count(), 0);
  export_slices(dir / "s/", 2, scene.view(), scene.grid);
  EXPECT_EQ(error_of([&] { export_slices(dir / "s", 2, scene.view(), scene.grid); }),
            (dir / "s").string() + ": exists and is not an empty folder: choose another name");
  EXPECT_EQ(dir.count(), 1);
}

}  // namespace
}  // namespace voxdag
