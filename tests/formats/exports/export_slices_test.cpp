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

TEST(ExportSlices, EmptyOnesAreLeftOutAndTheOthersKeepTheirPlaces) {
  const TempDir dir;
  ExportedScene scene(4, 0);
  scene.voxels = {{1, 2, 5}, {3, 9, 5}, {3, 15, 7}, {4, 4, 12}};
  scene.dag = brute_svdag(4, scene.voxels);
  ExportOptions options = windowed({1, 1, 3}, {16, 16, 16});
  options.skip_empty = true;
  for (int axis = 0; axis < 3; ++axis) {
    const auto folder = dir / std::to_string(axis);
    export_slices(folder, axis, scene.view(), scene.grid, options);
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      files += entry.path().extension() == ".png" ? 1 : 0;
    EXPECT_EQ(files, axis == 1 ? 4u : 3u);
    const auto source = open_voxel_source(folder);
    EXPECT_TRUE(source->warnings().empty());
    std::set<VoxelKey> found, expected;
    source->visit_all([&](const VoxelBatch& batch) {
      for (const auto& place : batch.places) {
        const Vec3i v(place);
        found.insert({v.x, v.y, v.z});
      }
    });
    for (const Vec3i v : scene.voxels) expected.insert({v.x, v.y, v.z});
    EXPECT_EQ(found, expected);
  }
  for (const char* slice : {"2/slice_0002.png", "2/slice_0004.png", "2/slice_0009.png"})
    EXPECT_TRUE(std::filesystem::exists(dir / slice)) << slice;
  // The file of a slice is the one that it has among all.
  export_slices(dir / "all", 2, scene.view(), scene.grid, windowed({1, 1, 3}, {16, 16, 16}));
  EXPECT_EQ(read_text(dir / "2/slice_0004.png"), read_text(dir / "all/slice_0004.png"));
  options.window = Box3i{{0, 0, 0}, {16, 16, 4}};
  EXPECT_EQ(error_of([&] { export_slices(dir / "no", 2, scene.view(), scene.grid, options); }),
            (dir / "no").string() + ": no slice is left: all are without voxels");
  EXPECT_EQ(dir.count(), 4);
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
