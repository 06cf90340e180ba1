/// Tests the way from Gaussian splats to collision files: `voxdag import`, `carve` and `export`.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "process.hpp"
#include "support/temp_dir.hpp"

namespace voxdag::cli {
namespace {

class SplatCommands : public testing::Test {
 protected:
  void SetUp() override {
    // A room of 8 x 4 x 8 with walls of splats, 0.5 apart. Splats are flat and dense enough.
    std::string rows;
    int count = 0;
    for (int i = 0; i <= 16; ++i)
      for (int j = 0; j <= 16; ++j)
        for (int k = 0; k <= 8; ++k)
          if (i % 16 == 0 || j % 16 == 0 || k % 8 == 0) {
            rows += std::to_string(i / 2.0) + " " + std::to_string(k / 2.0) + " " +
                    std::to_string(j / 2.0) + " 1 0 0 3 -1.4 -1.4 -1.4 1 0 0 0\n";
            ++count;
          }
    std::string header = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) + "\n";
    for (const char* name : {"x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0",
                             "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"})
      header += std::string("property float ") + name + "\n";
    write_text(path("room.ply"), header + "end_header\n" + rows);
  }
  std::string path(const std::string& name) const { return dir_ / name; }
  nlohmann::json json_of(std::vector<std::string> words) const {
    words.push_back("--json");
    const ProcessResult result = run_voxdag(words);
    EXPECT_EQ(result.status, 0) << result.err;
    return nlohmann::json::parse(result.out);
  }

  TempDir dir_;
};

TEST_F(SplatCommands, ARoomBecomesACollisionFile) {
  const ProcessResult import =
      run_voxdag({"import", path("room.ply"), "--voxel-size", "0.1", "--padding", "2",
                  "--max-scale", "1", "--opacity", "0.3", "-o", path("room.vdag")});
  ASSERT_EQ(import.status, 0) << import.err;
  EXPECT_NE(import.out.find("splats        opacity 0.3, scales 0.05 to 1"), std::string::npos)
      << import.out;
  EXPECT_EQ(run_voxdag({"verify", path("room.vdag")}).status, 0);
  // The DAG of another output has no name, and no folder for files that are sorted.
  const ProcessResult array = run_voxdag({"import", path("room.ply"), "--voxel-size", "0.4",
                                          "--max-scale", "1", "-o", path("room.npy")});
  EXPECT_EQ(array.status, 0) << array.err;
  ASSERT_EQ(run_voxdag({"carve", path("room.vdag"), "--from", "4,2,4", "--capsule", "1,0.2",
                        "--solid", "--drop-attributes", "-o", path("solid.vdag")})
                .status,
            0);
  ASSERT_EQ(run_voxdag({"carve", path("room.vdag"), "--from", "4,2,4", "--capsule", "1,0.2", "-o",
                        path("wall.vdag")})
                .status,
            0);
  EXPECT_EQ(run_voxdag({"verify", path("wall.vdag")}).status, 0);
  // The capsule takes the room up to its walls, which are some voxels thick.
  const std::uint64_t solid = json_of({"query", path("solid.vdag"), "--count"})["voxels"],
                      wall = json_of({"query", path("wall.vdag"), "--count"})["voxels"];
  EXPECT_GT(solid, 0u);
  EXPECT_GT(wall, 2u * (68 * 68 + 2 * 68 * 28));
  EXPECT_LE(wall, 2u * (82 * 82 + 2 * 82 * 42));
  ASSERT_EQ(run_voxdag({"export", path("solid.vdag"), "-o", path("room.voxel.json")}).status, 0);
  ASSERT_EQ(run_voxdag({"export", path("wall.vdag"), "-o", path("wall.glb")}).status, 0);
  const ProcessResult blocked = run_voxdag({"carve", path("room.vdag"), "--from", "0,2,4",
                                            "--capsule", "1,0.2", "-o", path("none.vdag")});
  expect_failure(blocked, 1, path("room.vdag") + ": the body cannot be at its first place");
}

TEST_F(SplatCommands, OptionsAreForSplats) {
  const auto refused = [&](std::vector<std::string> words, int status, const std::string& text) {
    words.insert(words.begin(), {"import", path("room.ply"), "-r", "64", "-o", path("n.vdag")});
    expect_failure(run_voxdag(words), status, text);
  };
  refused({"--opacity", "1"}, 2, "must be above 0 and below 1");
  refused({"--points", "--opacity", "0.5"}, 1, "is not read as splats");
  refused({"--max-scale", "0.001"}, 1, "has only splats that are too large");
  const nlohmann::json points =
      json_of({"import", path("room.ply"), "-r", "64", "--points", "-o", path("points.vdag")});
  EXPECT_EQ(points["voxels"], points["read"]);
  const nlohmann::json splats =
      json_of({"import", path("room.ply"), "-r", "64", "--max-scale", "1", "-o", path("s.vdag")});
  EXPECT_GT(splats["voxels"], 2 * splats["read"].get<int>());
  EXPECT_EQ(splats["too_large"], 0);
}

}  // namespace
}  // namespace voxdag::cli
