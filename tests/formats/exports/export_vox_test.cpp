#include "voxdag/formats/exports/grids/export_vox.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>

#include "read_back.hpp"
#include "support/temp_dir.hpp"

namespace voxdag {
namespace {

TEST(ExportVox, FewColorsAreReadBackExactly) {
  const TempDir dir;
  const ColoredScene scene(2);
  const auto files = export_vox(dir / "v.vox", scene.view(), scene.grid, scene.options);
  EXPECT_EQ(files, std::vector{dir / "v.vox"});
  // The importer moves the scene to the corner of the grid.
  ColoredVoxels expected = colored_voxels_of(scene, whole_grid(6));
  EXPECT_EQ(read_back(dir / "v.vox"), expected);
  EXPECT_EQ(placement_of(dir / "v.vox")["array"]["content"],
            "a scene; voxel window.lo lies at -32, -32, 0");
}

TEST(ExportVox, ManyColorsAreNearThoseOfThePalette) {
  const TempDir dir;
  const ColoredScene scene(6);
  export_vox(dir / "v.vox", scene.view(), scene.grid, scene.options);
  const ColoredVoxels expected = colored_voxels_of(scene, whole_grid(6));
  const ColoredVoxels found = read_back(dir / "v.vox");
  ASSERT_EQ(found.size(), expected.size());
  std::set<Rgb8> colors;
  double sum = 0;
  for (const auto& [voxel, color] : expected) {
    const Rgb8 other = found.at(voxel);
    colors.insert(other);
    for (std::size_t i = 0; i < 3; ++i) sum += (color[i] - other[i]) * (color[i] - other[i]);
  }
  EXPECT_LE(colors.size(), 255u);
  EXPECT_GT(colors.size(), 100u);
  // A cell of the palette's counter is 4 wide: values in it are at most 1.5 from their mean.
  EXPECT_LT(std::sqrt(sum / static_cast<double>(expected.size())), 1.5 * std::sqrt(3));
}

TEST(ExportVox, ModelsOf256AndWindowsAreCentred) {
  const TempDir dir;
  const ExportedScene scene(9, 3000);
  const Box3i window{{100, 3, 7}, {500, 512, 300}};
  export_vox(dir / "v.vox", scene.view(), scene.grid, windowed(window.lo, window.hi));
  const ColoredVoxels expected = voxels_of(scene, window);
  ColoredVoxels found = read_back(dir / "v.vox");
  EXPECT_EQ(found.size(), expected.size());
  // Relative to their first voxel, as the importer places the least one at 0.
  const auto corner = [](const ColoredVoxels& voxels) {
    Vec3i lo{1 << 20, 1 << 20, 1 << 20};
    for (const auto& [v, color] : voxels)
      lo = min(lo, {std::get<0>(v), std::get<1>(v), std::get<2>(v)});
    return lo;
  };
  const Vec3i move = corner(expected) - corner(found);
  ColoredVoxels moved;
  for (const auto& [v, color] : found) {
    EXPECT_EQ(color, (Rgb8{200, 198, 195}));
    moved[{std::get<0>(v) + move.x, std::get<1>(v) + move.y, std::get<2>(v) + move.z}] = {};
  }
  EXPECT_EQ(moved, expected);
}

/// The first voxels and the sizes of the models in a .vox file.
std::vector<std::pair<Vec3i, Vec3i>> models(const std::string& bytes) {
  std::vector<std::pair<Vec3i, Vec3i>> result;
  for (std::size_t at = bytes.find("SIZE"); at != std::string::npos;
       at = bytes.find("SIZE", at + 1)) {
    Vec3i size;
    std::memcpy(&size, bytes.data() + at + 12, sizeof size);
    result.emplace_back(Vec3i{}, size);
  }
  std::size_t model = 0;
  for (std::size_t at = bytes.find("_t"); at != std::string::npos; at = bytes.find("_t", at + 1)) {
    Vec3i middle;
    EXPECT_EQ(std::sscanf(bytes.c_str() + at + 6, "%d %d %d", &middle.x, &middle.y, &middle.z), 3);
    auto& [first, size] = result.at(model++);
    first = middle - Vec3i{size.x / 2, size.y / 2, size.z / 2};
  }
  return result;
}

TEST(ExportVox, LargeGridsAreCutIntoSectionsThatMagicaVoxelShows) {
  const TempDir dir;
  const ExportedScene scene(12, 50);
  const auto files = export_vox(dir / "v.vox", scene.view(), scene.grid);
  EXPECT_GT(files.size(), 1u);
  EXPECT_EQ(dir.count(), 2 * static_cast<int>(files.size()) + 1);  // Each has its placement.
  std::size_t voxels = 0;
  std::set<VoxelKey> places;
  for (const auto& file : files) {
    voxels += read_back(file).size();
    const auto placed = open_voxel_source(file);
    EXPECT_EQ(placed->grid()->origin, scene.grid.origin);
    EXPECT_EQ(placed->grid()->levels, 12);
    placed->visit_all([&](const VoxelBatch& batch) {
      for (const Vec3d p : batch.places) {
        const Vec3i v(p);
        places.insert({v.x, v.y, v.z});
      }
    });
    for (const auto& [first, size] : models(read_text(file)))
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(first[axis], -1000);
        EXPECT_LE(first[axis] + size[axis], 1000);
      }
  }
  EXPECT_EQ(voxels, scene.set.size());
  EXPECT_EQ(places, scene.set);
  EXPECT_TRUE(std::filesystem::exists(dir / "v.vox.json"));
}

}  // namespace
}  // namespace voxdag
