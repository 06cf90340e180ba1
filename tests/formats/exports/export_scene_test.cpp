// Scenes that are turned for a format, and come back as they were.
#include "voxdag/formats/exports/export_scene.hpp"

#include <gtest/gtest.h>

#include "read_back.hpp"
#include "support/error_of.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/formats/imports/import_model.hpp"

namespace voxdag {
namespace {

SceneMetadata metadata_of(const ExportedScene& scene, const std::string& source) {
  SceneMetadata metadata;
  metadata.grid = scene.grid;
  metadata.source.name = source;
  return metadata;
}

TEST(ExportScene, TheSourceTellsWhichAxisPointsUp) {
  const auto up = [](const std::string& name, const std::string& setting = "") {
    SceneMetadata metadata;
    metadata.source.name = name;
    if (!setting.empty()) metadata.build["up"] = setting;
    return up_of(metadata).value_or('-');
  };
  EXPECT_EQ(up("a.GLB"), 'y');
  EXPECT_EQ(up("a.vox"), 'z');
  EXPECT_EQ(up("a.stl.gz"), 'z');
  EXPECT_EQ(up("a.obj"), '-');
  EXPECT_EQ(up("a.glb", "z"), 'z');
  EXPECT_EQ(up("a.vox", "x"), '-');
}

/// Returns the voxels less their least coordinates.
ColoredVoxels from_zero(const ColoredVoxels& voxels) {
  Vec3i lo{1 << 20, 1 << 20, 1 << 20};
  for (const auto& [v, color] : voxels)
    lo = min(lo, {std::get<0>(v), std::get<1>(v), std::get<2>(v)});
  ColoredVoxels moved;
  for (const auto& [v, color] : voxels)
    moved[{std::get<0>(v) - lo.x, std::get<1>(v) - lo.y, std::get<2>(v) - lo.z}] = color;
  return moved;
}

TEST(ExportScene, VoxFilesStandUprightAndComeBack) {
  const TempDir dir;
  const ColoredScene scene(2);  // has fewer colours than a palette
  for (const bool has_window : {false, true}) {
    ExportOptions options = scene.options;
    if (has_window) options.window = kWindow;
    export_scene(dir / "a.vox", scene.view(), metadata_of(scene, "a.glb"), {}, options);
    const Box3i box = options.window.value_or(whole_grid(6));
    // y points up in the scene: (x, y, z) is (x, -z, y) in the file.
    ColoredVoxels turned;
    for (const auto& [voxel, color] : colored_voxels_of(scene, box)) {
      const auto& [x, y, z] = voxel;
      turned[{x, 63 - z, y}] = color;
    }
    EXPECT_EQ(from_zero(read_back(dir / "a.vox")), from_zero(turned));
    const auto placed = open_voxel_source(dir / "a.vox");
    EXPECT_EQ(placed->grid()->origin, scene.grid.origin);
    EXPECT_EQ(placed->grid()->voxel_size, scene.grid.voxel_size);
    EXPECT_EQ(placed->up(), 'y');
    ColoredVoxels back;
    placed->visit_all([&](const VoxelBatch& batch) {
      for (std::size_t i = 0; i < batch.places.size(); ++i) {
        const Vec3i v(batch.places[i]);
        back[{v.x, v.y, v.z}] = batch.colors[i];
      }
    });
    EXPECT_EQ(back, colored_voxels_of(scene, box));
    ImportOptions import;
    import.folder = dir.path();
    const ImportedModel model = import_model(*placed, import, "a.vox");
    EXPECT_EQ(up_of(model.model.metadata()), 'y');
  }
}

TEST(ExportScene, NormalsAndWorldAreTurned) {
  const TempDir dir;
  const ColoredScene scene(6);
  ExportContent content;
  content.up = 'y';
  export_scene(dir / "a.ply", scene.view(), metadata_of(scene, "a.obj"), {}, scene.options);
  export_scene(dir / "b.ply", scene.view(), metadata_of(scene, "a.obj"), content, scene.options);
  const auto points_of = [&](const char* name) {
    std::vector<std::pair<Vec3d, Rgb8>> points;
    open_voxel_source(dir / name)->visit_all([&](const VoxelBatch& batch) {
      for (std::size_t i = 0; i < batch.places.size(); ++i)
        points.emplace_back(batch.places[i], batch.colors[i]);
    });
    std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
      const auto key = [](Vec3d p) { return std::tuple(p.x, p.y, p.z); };
      return key(a.first) < key(b.first);
    });
    return points;
  };
  auto expected = points_of("a.ply");
  // The import turns the points back to their places.
  EXPECT_EQ(points_of("b.ply"), expected);
  EXPECT_EQ(open_voxel_source(dir / "b.ply")->up(), 'z');
  EXPECT_EQ(open_voxel_source(dir / "b.ply")->grid()->origin, scene.grid.origin);
  EXPECT_EQ(open_voxel_source(dir / "a.ply")->up(), std::nullopt);
  // Other programs see the turned ones.
  std::string bytes = read_text(dir / "b.ply");
  bytes.replace(bytes.find("made by voxdag"), 14, "made by others");
  write_text(dir / "b.ply", bytes);
  for (auto& [p, color] : expected) p = {p.x, p.z, -p.y};
  auto found = points_of("b.ply");
  ASSERT_EQ(found.size(), expected.size());
  std::map<std::tuple<double, double, double>, Rgb8> by_place;
  for (const auto& [p, color] : expected) by_place[{p.x, p.y, p.z}] = color;
  for (const auto& [p, color] : found) EXPECT_EQ(by_place.at({p.x, p.y, p.z}), color);
}

TEST(ExportScene, TheCustomOfAFormatDoesNotTurnWhatIsUnknown) {
  const TempDir dir;
  const ColoredScene scene(6);
  export_scene(dir / "a.vox", scene.view(), metadata_of(scene, "a.obj"), {}, scene.options);
  export_voxels(dir / "b.vox", scene.view(), scene.grid, {}, scene.options);
  EXPECT_EQ(read_text(dir / "a.vox"), read_text(dir / "b.vox"));
  EXPECT_EQ(read_text(dir / "a.vox.json"), read_text(dir / "b.vox.json"));
}

}  // namespace
}  // namespace voxdag
