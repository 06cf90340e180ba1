// Exports plain arrays: .npy and .raw.
#include <gtest/gtest.h>

#include <random>

#include "exported_scene.hpp"
#include "support/error_of.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/file/npy.hpp"

namespace voxdag {
namespace {

TEST(ExportNpy, CoordinatesAreTheVoxelsInMortonOrder) {
  const TempDir dir;
  const ExportedScene scene(7, 30000);
  export_npy_coordinates(dir / "v.npy", scene.view(), scene.grid);
  NpyReader reader(dir / "v.npy", "<i4", {3}, 4);
  ASSERT_EQ(reader.rows(), scene.set.size());
  std::vector<Vec3i> rows(reader.rows());
  reader.read_rows(rows.data(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_TRUE(scene.has(rows[i].x, rows[i].y, rows[i].z));
    if (i == 0) continue;
    EXPECT_LT(morton_encode(rows[i - 1]), morton_encode(rows[i]));
  }
}

TEST(ExportNpy, CoordinatesKeepToTheWindow) {
  const TempDir dir;
  const ExportedScene scene(5, 2000);
  export_npy_coordinates(dir / "v.npy", scene.view(), scene.grid, windowed({1, 2, 3}, {9, 21, 30}));
  NpyReader reader(dir / "v.npy", "<i4", {3}, 4);
  std::size_t expected = 0;
  for (const auto& [x, y, z] : scene.set)
    expected += x >= 1 && y >= 2 && z >= 3 && x < 9 && y < 21 && z < 30;
  EXPECT_EQ(reader.rows(), expected);
}

TEST(ExportNpy, ThePlacementIsWrittenBesideIt) {
  const TempDir dir;
  const ExportedScene scene(5);
  export_npy_dense(dir / "v.npy", scene.view(), scene.grid, windowed({1, 2, 3}, {9, 21, 30}));
  const nlohmann::json json = placement_of(dir / "v.npy");
  EXPECT_EQ(json["grid"]["origin"], nlohmann::json({10.0, -20.0, 0.5}));
  EXPECT_EQ(json["grid"]["voxel_size"], 0.25);
  EXPECT_EQ(json["grid"]["resolution"], 32);
  EXPECT_EQ(json["window"]["lo"], nlohmann::json({1, 2, 3}));
  EXPECT_EQ(json["window"]["hi"], nlohmann::json({9, 21, 30}));
  EXPECT_EQ(json["array"]["axes_slowest_to_fastest"], "xyz");
  EXPECT_EQ(json["array"]["shape"], nlohmann::json({8, 19, 27}));
  EXPECT_EQ(dir.count(), 2);
}

TEST(ExportNpy, ADenseWindowHasZFastest) {
  const TempDir dir;
  const ExportedScene scene(5, 2000);
  const Vec3i lo{1, 2, 3}, hi{9, 21, 30};
  export_npy_dense(dir / "v.npy", scene.view(), scene.grid, windowed(lo, hi));
  NpyReader reader(dir / "v.npy", "|u1", {19, 27}, 1);
  ASSERT_EQ(reader.rows(), 8u);
  std::vector<unsigned char> bytes(8 * 19 * 27);
  reader.read_rows(bytes.data(), 8);
  std::size_t at = 0;
  for (int x = lo.x; x < hi.x; ++x)
    for (int y = lo.y; y < hi.y; ++y)
      for (int z = lo.z; z < hi.z; ++z) ASSERT_EQ(bytes[at++] != 0, scene.has(x, y, z));
}

TEST(ExportRaw, TheWholeGridHasXFastest) {
  const TempDir dir;
  const ExportedScene scene(5, 2000);
  export_raw(dir / "v.raw", scene.view(), scene.grid);
  const std::string bytes = read_text(dir / "v.raw");
  ASSERT_EQ(bytes.size(), 32u * 32 * 32);
  std::size_t at = 0;
  for (int z = 0; z < 32; ++z)
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x) ASSERT_EQ(bytes[at++] != 0, scene.has(x, y, z));
  EXPECT_EQ(placement_of(dir / "v.raw")["array"]["axes_slowest_to_fastest"], "zyx");
}

/// Arrays of more than one strip. Strips end between layers and within a layer.
TEST(ExportRaw, LargeArraysAreWrittenInStrips) {
  const TempDir dir;
  for (const auto& [levels, size] : {std::pair{11, Vec3i{2048, 2048, 11}}, {13, {8192, 6000, 1}}}) {
    std::vector<Vec3i> voxels;
    std::mt19937 rng(1);
    for (int i = 0; i < 2000; ++i)
      voxels.push_back({static_cast<int>(rng() % size.x), static_cast<int>(rng() % size.y),
                        static_cast<int>(rng() % size.z)});
    const Svdag dag = brute_svdag(levels, voxels);
    Grid grid;
    grid.levels = levels;
    export_raw(dir / "v.raw", dag.view(), grid, windowed({0, 0, 0}, size));
    std::string bytes = read_text(dir / "v.raw");
    ASSERT_EQ(bytes.size(), std::size_t(size.x) * size.y * size.z);
    for (const Vec3i v : voxels) {
      char& byte = bytes[v.x + std::size_t(size.x) * (v.y + std::size_t(size.y) * v.z)];
      byte = byte == 0 ? 2 : 3;  // 2: the voxel was not set, but should be
      ASSERT_EQ(byte, 3);
    }
    EXPECT_EQ(std::count(bytes.begin(), bytes.end(), 1), 0);
  }
}

TEST(ExportRaw, TooLargeAnArrayIsRefusedWithItsSize) {
  const TempDir dir;
  const ExportedScene scene(15, 10);
  EXPECT_EQ(error_of([&] { export_raw(dir / "v.raw", scene.view(), scene.grid); }),
            (dir / "v.raw").string() +
                ": a dense array of 32768 x 32768 x 32768 voxels has 35184372088832 bytes, more "
                "than the limit of 17179869184: choose a smaller window");
  EXPECT_EQ(dir.count(), 0);
}

}  // namespace
}  // namespace voxdag
