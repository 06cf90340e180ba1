// Grids of OpenVDB, which the importer reads back. tests/interop opens them with other programs.
#include "voxdag/formats/exports/grids/export_vdb.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exported_scene.hpp"
#include "support/error_of.hpp"
#include "support/temp_dir.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/algebra/attributes/channel_of_voxels.hpp"
#include "voxdag/formats/imports/import_voxels.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"

namespace voxdag {
namespace {

[[maybe_unused]] std::set<VoxelKey> read_vdb_back(const std::filesystem::path& path,
                                                  Vec3i moved_by) {
  std::set<VoxelKey> voxels;
  open_voxel_source(path)->visit_all([&](const VoxelBatch& batch) {
    for (const Vec3d place : batch.places) {
      const Vec3i v = Vec3i(place) + moved_by;
      EXPECT_TRUE(voxels.insert({v.x, v.y, v.z}).second);
    }
  });
  return voxels;
}

#if VOXDAG_HAS_VDB_EXPORT

TEST(ExportVdb, VoxelsAndFullCellsAreReadBack) {
  const TempDir dir;
  // Full cells of 8³, 32³ and more, which become tiles, and single voxels.
  const std::vector<Vec3i> voxels = voxels_where(6, [](Vec3i v) {
    return v.x >= 32 || (v.x < 8 && v.y < 8) || (v.x + 3 * v.y + 5 * v.z) % 7 == 0;
  });
  const Svdag dag = brute_svdag(6, voxels);
  Grid grid;
  grid.levels = 6;
  grid.origin = {10, -20, 0.5};
  grid.voxel_size = 0.25;
  for (const Box3i& window : {whole_grid(6), Box3i{{3, 1, 6}, {61, 64, 33}}}) {
    std::set<VoxelKey> expected;
    Vec3i lo{64, 64, 64};
    for (const Vec3i v : voxels) {
      bool is_inside = true;
      for (int axis = 0; axis < 3; ++axis)
        is_inside &= v[axis] >= window.lo[axis] && v[axis] < window.hi[axis];
      if (!is_inside) continue;
      expected.insert({v.x, v.y, v.z});
      lo = min(lo, v);
    }
    export_vdb(dir / "v.vdb", dag.view(), grid, windowed(window.lo, window.hi));
    EXPECT_EQ(read_vdb_back(dir / "v.vdb", lo), expected);
    const Grid back = *open_voxel_source(dir / "v.vdb")->grid();
    EXPECT_NEAR(back.voxel_size, 0.25, 1e-9);
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(back.origin[axis], grid.to_world(Vec3d(lo))[axis], 1e-9);
  }
}

TEST(ExportVdb, ChannelsAreGridsOfTheirValues) {
  const TempDir dir;
  const ExportedScene scene(6, 500);
  const auto heat = [](Vec3i v) { return 2.5 + 2.5 * ((v.x * 7 + v.y) % 5); };
  const auto size = [](Vec3i v) { return 1.0 + v.x * v.z % 5; };
  DagAttributes attributes;
  attributes.index = build_cell_index(scene.view(), 6);
  const CellIndexView index = attributes.index.view();
  const EncodedChannel channels[] = {
      channel_of_voxels(scene.view(), index, {"heat"}, heat),
      channel_of_voxels(scene.view(), index, {"density", ChannelKind::kU8}, size)};
  attributes.channels = join_channels(attributes.index.cells, channels);
  ExportOptions options;
  options.look = ColoredDagView{scene.view(), attributes.view()};
  export_vdb(dir / "v.vdb", scene.view(), scene.grid, options);
  // The voxels at or above each threshold tell every value.
  const auto expect_grid = [&](const std::string& name, double step, const auto& value) {
    for (double least = step; least <= 50; least += step) {
      std::set<VoxelKey> expected, found;
      for (const Vec3i v : scene.voxels)
        if (value(v) >= least) expected.insert({v.x, v.y, v.z});
      if (expected.empty()) break;
      const auto source = open_voxel_source(dir / "v.vdb", {.threshold = least, .grid = name});
      const Grid grid = *source->grid();
      const Vec3d shift = (grid.origin - scene.grid.origin) * (1 / scene.grid.voxel_size);
      source->visit_all([&](const VoxelBatch& batch) {
        for (const Vec3d place : batch.places)
          found.insert({static_cast<int>(std::lround(place.x + shift.x)),
                        static_cast<int>(std::lround(place.y + shift.y)),
                        static_cast<int>(std::lround(place.z + shift.z))});
      });
      EXPECT_EQ(found, expected) << name << " from " << least;
    }
  };
  expect_grid("heat", 2.5, heat);
  expect_grid("channel_density", 1, size);
  expect_grid("density", 1, [](Vec3i) { return 1.0; });
}

TEST(ExportVdb, EqualVoxelsMakeEqualFiles) {
  const TempDir dir;
  const ExportedScene scene(6, 2000);
  for (const char* end : {".vdb", ".nvdb"}) {
    export_vdb(dir / (std::string("a") + end), scene.view(), scene.grid);
    export_vdb(dir / (std::string("b") + end), scene.view(), scene.grid);
    EXPECT_EQ(read_text(dir / (std::string("a") + end)), read_text(dir / (std::string("b") + end)));
  }
}

TEST(ExportVdb, KeepsToItsMemory) {
  const TempDir dir;
  const ExportedScene scene(8, 30000);
  MemoryBudget memory(std::uint64_t{40} << 20);
  ExportOptions options;
  options.memory = &memory;
  EXPECT_THROW(export_vdb(dir / "v.vdb", scene.view(), scene.grid, options), OverMemory);
  EXPECT_EQ(dir.count(), 0);
  EXPECT_EQ(memory.used(), 0u);
}

TEST(ExportVdb, AFullDiskIsAnError) {
  const ExportedScene scene(5, 300);
  EXPECT_EQ(error_of([&] { export_vdb("/dev/full", scene.view(), scene.grid); }),
            "/dev/full: byte 0: cannot write: No space left on device");
}

#else

TEST(ExportVdb, NeedsItsModule) {
  const TempDir dir;
  const ExportedScene scene(4, 10);
  EXPECT_TRUE(error_of([&] {
                export_vdb(dir / "v.vdb", scene.view(), scene.grid);
              }).find("is written by a module that is built where OpenVDB") != std::string::npos);
}

#endif

}  // namespace
}  // namespace voxdag
