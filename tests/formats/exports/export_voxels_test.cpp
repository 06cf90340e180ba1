#include "voxdag/formats/exports/export_voxels.hpp"

#include <gtest/gtest.h>

#include "exported_ply.hpp"
#include "support/error_of.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/file/npy.hpp"
#include "voxdag/formats/exports/count_voxels.hpp"

namespace voxdag {
namespace {

TEST(Export, AWindowMustLieInTheGrid) {
  const TempDir dir;
  const ExportedScene scene(4);
  const auto with = [&](Vec3i lo, Vec3i hi) {
    return voxdag::error_of(
        [&] { export_npy_dense("v.npy", scene.view(), scene.grid, windowed(lo, hi)); });
  };
  EXPECT_EQ(with({0, 0, 0}, {17, 1, 1}),
            "v.npy: window: extends beyond the grid of 16 voxels a side");
  EXPECT_EQ(with({-1, 0, 0}, {1, 1, 1}),
            "v.npy: window: extends beyond the grid of 16 voxels a side");
  EXPECT_EQ(with({0, 5, 0}, {1, 5, 1}),
            "v.npy: window: is empty: each end must be greater than its start");
}

TEST(Export, TheExtensionChooses) {
  const TempDir dir;
  const ExportedScene scene(3, 20);
  const auto run = [&](const std::string& name, bool ply_faces = false) {
    export_voxels(dir / name, scene.view(), scene.grid, {ply_faces});
    return read_text(dir / name);
  };
  EXPECT_EQ(run("a.npy").substr(1, 5), "NUMPY");
  EXPECT_EQ(run("a.raw").size(), 512u);
  EXPECT_TRUE(ExportedPly(run("a.ply")).faces.empty());
  EXPECT_FALSE(ExportedPly(run("b.ply", true)).faces.empty());
  EXPECT_EQ(
      error_of([&] { run("a.xyz"); }),
      (dir / "a.xyz").string() +
          ": cannot export to '.xyz': the extension must be .spc.npy, .npy, .raw, .ply, .glb, "
          ".obj, .stl, .3mf, .vox, .binvox, .schem, .voxel.json, .nrrd, .mha, .mhd, "
          ".vti, .nii, .nii.gz, .vdb or .nvdb");
}

TEST(Export, ThePlacementOfAnEarlierExportGoes) {
  const TempDir dir;
  const ExportedScene scene(3, 20);
  const auto run = [&](const char* format) {
    ExportContent content;
    content.format = format;
    export_voxels(dir / "a", scene.view(), scene.grid, content);
    return std::filesystem::exists(dir / "a.json");
  };
  for (const char* format : {"binvox", "ply", "stl", "obj"}) {
    EXPECT_TRUE(run("npy")) << format;
    EXPECT_FALSE(run(format)) << format;
  }
  // Files of other programs stay.
  write_text(dir / "a.json", "{\"grid\": 1}");
  EXPECT_TRUE(run("ply"));
}

TEST(Export, AnEmptyDagMakesEmptyFiles) {
  const TempDir dir;
  const ExportedScene scene(4, 0);
  export_npy_coordinates(dir / "v.npy", scene.view(), scene.grid);
  EXPECT_EQ(NpyReader(dir / "v.npy", "<i4", {3}, 4).rows(), 0u);
  export_ply_faces(dir / "v.ply", scene.view(), scene.grid);
  EXPECT_TRUE(ExportedPly(read_text(dir / "v.ply")).vertices.empty());
}

TEST(Export, VoxelsAreCountedAsTheyAreEnumerated) {
  const ExportedScene scene(8, 3000);
  const std::uint64_t most = 1 << 30;
  for (const Box3i& window : {Box3i{{0, 0, 0}, {256, 256, 256}}, Box3i{{3, 0, 17}, {200, 256, 18}},
                              Box3i{{1, 2, 3}, {255, 254, 253}}, Box3i{{5, 5, 5}, {6, 6, 6}}}) {
    std::uint64_t enumerated = 0;
    VoxelSet(scene.view()).for_each_voxel(window, [&](Vec3i) { ++enumerated; });
    EXPECT_EQ(count_voxels(scene.view(), window, most, [] {}), enumerated);
  }
  EXPECT_EQ(count_voxels(scene.view(), whole_grid(8), 10, [] {}), 11u);
}

/// A full cube of 2^levels voxels per side: one node per level.
struct FullCube {
  explicit FullCube(int levels) {
    nodes.clear();
    for (int level = 0; level < levels - 2; ++level) {
      const auto next = static_cast<std::uint32_t>(9 * (level + 1));
      nodes.push_back(0xff);
      nodes.insert(nodes.end(), 8, level + 1 == levels - 2 ? 0 : next);
    }
  }
  std::vector<std::uint32_t> nodes;
  std::uint64_t block = ~std::uint64_t{0};
};

TEST(Export, AnOutputLargerThanTheDiskIsRefusedAtOnce) {
  FullCube cube(20);
  SvdagView view;
  view.levels = 20;
  view.nodes = cube.nodes.data();
  view.leaf_blocks = &cube.block;
  view.leaf_block_count = 1;
  EXPECT_EQ(count_voxels(view, whole_grid(20), ~std::uint64_t{0} - 1, [] {}),
            std::uint64_t{1} << 60);
  Grid grid;
  grid.levels = 20;
  const TempDir dir;
  for (const char* name : {"v.npy", "v.ply"})
    EXPECT_NE(error_of([&] {
                export_voxels(dir / name, view, grid);
              }).find("bytes that are free on its disk"),
              std::string::npos);
  EXPECT_EQ(dir.count(), 0);
}

TEST(Export, CancellingLeavesNothing) {
  const TempDir dir;
  const ExportedScene scene(5, 100);
  ExportOptions options;
  options.progress = [](double, std::uint64_t) { throw Cancelled(); };
  EXPECT_THROW(export_raw(dir / "v.raw", scene.view(), scene.grid, options), Cancelled);
  EXPECT_EQ(dir.count(), 0);
}

TEST(Export, AFullDiskIsAnError) {
  const ExportedScene scene(5, 100);
  EXPECT_EQ(error_of([&] { export_raw("/dev/full", scene.view(), scene.grid); }),
            "/dev/full: byte 0: cannot write: No space left on device");
}

}  // namespace
}  // namespace voxdag
