/// Tests the flights through real scenes: they are valid camera paths, and the camera stays away
/// from the scene. The folder that VOXDAG_SCENES names has the scenes.
#include "lab/papers/camera_paths.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lab/papers/paper_scenes.hpp"
#include "support/clearance.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/core/io/checksum.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/render/film/camera_path.hpp"

namespace voxdag::lab {

void PrintTo(const SceneFlight& flight, std::ostream* out) { *out << flight.name; }

namespace {

namespace fs = std::filesystem;

/// Returns the flight's mesh in the folder that VOXDAG_SCENES names or below it, or nothing.
std::optional<fs::path> mesh_of(const SceneFlight& flight) {
  const char* folder = std::getenv("VOXDAG_SCENES");
  if (folder == nullptr || !fs::is_directory(folder)) return {};
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().filename() == flight.file &&
        xxh3_64(MappedFile(entry.path()).bytes()) == flight.file_check)
      return entry.path();
  return {};
}

CameraPath camera_path(const SceneFlight& flight) {
  std::vector<CameraKey> keys;
  for (const SceneKey& key : flight.keys)
    keys.push_back({key.time, {key.eye, key.target, flight.up, flight.fov_degrees}});
  return CameraPath(std::move(keys));
}

class CameraPaths : public testing::TestWithParam<SceneFlight> {};

TEST_P(CameraPaths, HaveAtLeastEightKeysFromTimeZero) {
  const CameraPath path = camera_path(GetParam());
  EXPECT_GE(GetParam().keys.size(), 8u);
  EXPECT_EQ(path.start(), 0);
  EXPECT_GE(path.end(), 20);
}

TEST_P(CameraPaths, AreThroughAPapersScene) {
  MeshIdentity mesh;
  mesh.name = GetParam().file;
  mesh.file_check = GetParam().file_check;
  EXPECT_TRUE(match_paper_scene(Paper::kSvdag, mesh).has_figures() ||
              match_paper_scene(Paper::kEsvo, mesh).has_figures());
}

TEST_P(CameraPaths, AreFoundByTheChecksumOfTheMesh) {
  const SceneFlight* found = flight_of(GetParam().file_check);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->name, GetParam().name);
  EXPECT_EQ(flight_of(GetParam().file_check + 1), nullptr);
}

TEST_P(CameraPaths, ArePrintedAsPathFiles) {
  const TempDir dir;
  write_text(dir / "path.json", path_json(path_file(preset_of(GetParam()))));
  const PathFile read = read_path_file(dir / "path.json");
  ASSERT_EQ(read.keys.size(), GetParam().keys.size());
  for (std::size_t i = 0; i < read.keys.size(); ++i) {
    EXPECT_EQ(read.keys[i].time, GetParam().keys[i].time);
    EXPECT_EQ(read.keys[i].eye, GetParam().keys[i].eye);
    EXPECT_EQ(read.keys[i].target, GetParam().keys[i].target);
  }
  EXPECT_EQ(read.keys[0].up, GetParam().up);
  EXPECT_EQ(read.keys[0].fov_degrees, GetParam().fov_degrees);
  EXPECT_EQ(read.sun, GetParam().sun_direction);
}

TEST_P(CameraPaths, KeepClearOfTheScene) {
  const SceneFlight& flight = GetParam();
  const std::optional<fs::path> file = mesh_of(flight);
  if (!file) GTEST_SKIP() << "VOXDAG_SCENES names no folder with the known " << flight.file;
  expect_clear_path(camera_path(flight), read_mesh(*file), flight.clearance, flight.clearance);
}

INSTANTIATE_TEST_SUITE_P(All, CameraPaths, testing::ValuesIn(scene_flights()),
                         [](const auto& flight) { return std::string(flight.param.name); });

}  // namespace
}  // namespace voxdag::lab
