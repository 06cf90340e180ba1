/// Tests the flights through real scenes: they are valid camera paths, and the camera stays away
/// from the scene. The folder that VOXDAG_SCENES names has the scenes.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include "support/clearance.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/core/io/checksum.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/render/film/camera_path.hpp"
#include "voxdag/render/film/path_file.hpp"

namespace voxdag::lab {
namespace {

namespace fs = std::filesystem;

/// A camera path in lab/report/flights.
struct SceneFlight {
  const char* name;
  const char* mesh;          ///< The name of the mesh's file.
  std::uint64_t mesh_check;  ///< XXH3-64 of the mesh's file.
  double clearance;          ///< Least distance of the camera from any surface, at 512³ voxels.
};

void PrintTo(const SceneFlight& flight, std::ostream* out) { *out << flight.name; }

constexpr SceneFlight kFlights[] = {{"crytek_sponza", "sponza.obj", 0xd5d755a4c62db15e, 35},
                                    {"sanmiguel", "sanmiguel_core.ply", 0x1b139a913bd76b81, 0.75},
                                    {"sibenik", "sibenik.obj", 0x660b8c8b0c33e732, 0.75}};

PathFile path_of(const SceneFlight& flight) {
  return read_path_file(fs::path(VOXDAG_SOURCE_DIR) / "lab/report/flights" /
                        (std::string(flight.name) + ".json"));
}

/// Returns the flight's mesh in the folder that VOXDAG_SCENES names or below it, or nothing.
std::optional<fs::path> mesh_of(const SceneFlight& flight) {
  const char* folder = std::getenv("VOXDAG_SCENES");
  if (folder == nullptr || !fs::is_directory(folder)) return {};
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().filename() == flight.mesh &&
        xxh3_64(MappedFile(entry.path()).bytes()) == flight.mesh_check)
      return entry.path();
  return {};
}

CameraPath camera_path(const PathFile& file) {
  std::vector<CameraKey> keys;
  for (const PathKey& key : file.keys)
    keys.push_back({key.time, {key.eye, key.target, *file.keys[0].up, *file.keys[0].fov_degrees}});
  return CameraPath(std::move(keys));
}

class CameraPaths : public testing::TestWithParam<SceneFlight> {};

TEST_P(CameraPaths, HaveAtLeastEightKeysFromTimeZero) {
  const PathFile file = path_of(GetParam());
  const CameraPath path = camera_path(file);
  EXPECT_GE(file.keys.size(), 8u);
  EXPECT_EQ(path.start(), 0);
  EXPECT_GE(path.end(), 20);
}

TEST_P(CameraPaths, AreStoredAsPathFilesArePrinted) {
  const PathFile file = path_of(GetParam());
  EXPECT_EQ(path_json(file), read_text(file.name));
  EXPECT_TRUE(file.sun && file.keys[0].up && file.keys[0].fov_degrees);
}

TEST_P(CameraPaths, KeepClearOfTheScene) {
  const SceneFlight& flight = GetParam();
  const std::optional<fs::path> mesh = mesh_of(flight);
  if (!mesh) GTEST_SKIP() << "VOXDAG_SCENES names no folder with the known " << flight.mesh;
  expect_clear_path(camera_path(path_of(flight)), read_mesh(*mesh), flight.clearance,
                    flight.clearance);
}

INSTANTIATE_TEST_SUITE_P(All, CameraPaths, testing::ValuesIn(kFlights),
                         [](const auto& flight) { return std::string(flight.param.name); });

}  // namespace
}  // namespace voxdag::lab
