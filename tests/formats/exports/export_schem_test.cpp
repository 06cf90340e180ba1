#include "voxdag/formats/exports/grids/export_schem.hpp"

#include <gtest/gtest.h>

#include "read_back.hpp"
#include "schematic.hpp"
#include "support/error_of.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/formats/exports/grids/block_palette.hpp"

namespace voxdag {
namespace {

TEST(ExportSchem, BlocksAreTheVoxels) {
  const TempDir dir;
  const ColoredScene scene(4);
  for (const bool has_colors : {false, true}) {
    ExportOptions options = has_colors ? scene.options : ExportOptions{};
    options.window = kWindow;
    export_schem(dir / "v.schem", scene.view(), scene.grid, options);
    Nbt nbt(unzipped(dir / "v.schem"));
    EXPECT_EQ(nbt.numbers["Version"], 2);
    EXPECT_EQ(nbt.numbers["Width"], 26);
    EXPECT_EQ(nbt.numbers["Height"], 31);
    EXPECT_EQ(nbt.numbers["Length"], 7);
    EXPECT_EQ(nbt.numbers["PaletteMax"], std::ssize(nbt.palette));
    ASSERT_EQ(nbt.blocks.size(), 26u * 31 * 7);
    const ColoredVoxels voxels = colored_voxels_of(scene, kWindow);
    std::size_t place = 0;
    for (int y = 1; y < 32; ++y)
      for (int z = 6; z < 13; ++z)
        for (int x = 3; x < 29; ++x) {
          const auto voxel = voxels.find({x, y, z});
          std::string block = "air";
          if (voxel != voxels.end()) {
            const auto [red, green, blue] = voxel->second;
            block = has_colors ? kColoredBlocks[nearest_block({red, green, blue})].name : "stone";
          }
          EXPECT_EQ(nbt.blocks[place++], nbt.palette.at("minecraft:" + block));
        }
  }
  EXPECT_TRUE(std::filesystem::exists(dir / "v.schem.json"));
}

TEST(ExportSchem, ColorsBecomeTheNearestBlocks) {
  for (int i = 0; i < std::ssize(kColoredBlocks); ++i)
    EXPECT_EQ(nearest_block(kColoredBlocks[i].color), i);
  EXPECT_STREQ(kColoredBlocks[nearest_block({255, 255, 255})].name, "white_concrete");
  EXPECT_STREQ(kColoredBlocks[nearest_block({0, 0, 0})].name, "black_concrete");
}

TEST(ExportSchem, LimitsAreToldBeforeTheWork) {
  const TempDir dir;
  const ExportedScene scene(16, 10);
  const std::string file = (dir / "v.schem").string();
  const std::string help = ": choose a smaller --window, or make a coarser grid (voxdag coarsen)";
  EXPECT_EQ(error_of([&] { export_schem(file, scene.view(), scene.grid); }),
            file + ": 65536 blocks along an axis are more than the 32767 of a schematic" + help);
  EXPECT_EQ(
      error_of([&] {
        export_schem(file, scene.view(), scene.grid, windowed({0, 0, 0}, {2048, 2048, 512}));
      }),
      file + ": 2147483648 blocks, with air, are more than the 2147483647 of a schematic" + help);
  EXPECT_EQ(dir.count(), 0);
}

}  // namespace
}  // namespace voxdag
