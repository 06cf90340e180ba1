/// Runs every command on procedural scenes.
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "npy_rays.hpp"
#include "sponge.hpp"

namespace voxdag::cli {
namespace {

TEST_F(Sponge, ListNamesTheScenesWithTheirSizes) {
  const ProcessResult list = run_voxdag({"scene", "--list"});
  EXPECT_EQ(list.status, 0);
  for (const char* name : {"courtyard", "hairball", "sponge"})
    EXPECT_NE(list.out.find(name), std::string::npos) << name;
  EXPECT_GE(nlohmann::json::parse(run_voxdag({"scene", "--list", "--json"}).out).size(), 3u);
}

TEST_F(Sponge, EverySceneHasAFlight) {
  for (const auto& scene : nlohmann::json::parse(run_voxdag({"scene", "--list", "--json"}).out)) {
    const ProcessResult result = run_voxdag({"scene", scene.at("name"), "--path"});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto path = nlohmann::json::parse(result.out);
    EXPECT_EQ(path.at("sun").size(), 3u);
    EXPECT_GE(path.at("keys").size(), 8u);
    EXPECT_EQ(path.at("keys").at(0).at("time"), 0);
  }
}

TEST_F(Sponge, QuietScenesPrintOnlyJson) {
  const auto scene = [&](const std::string& option) {
    return run_voxdag(
        {"scene", "hairball", "--size", "10", "-o", path("quiet.ply"), "--quiet", option});
  };
  const ProcessResult quiet = scene("--seed=1");
  EXPECT_EQ(quiet.status, 0) << quiet.err;
  EXPECT_EQ(quiet.out + quiet.err, "");
  EXPECT_TRUE(exists("quiet.ply"));
  EXPECT_GT(nlohmann::json::parse(scene("--json").out).at("triangles"), 0);
}

TEST_F(Sponge, UnknownScenesAndSizesAreRefused) {
  expect_failure(run_voxdag({"scene", "nowhere", "-o", path("x.ply")}), 1, "nowhere");
  expect_failure(run_voxdag({"scene", "sponge", "--size", "99", "-o", path("x.ply")}), 1, "99");
  expect_failure(run_voxdag({"scene", "sponge"}), 2, "--output");
  expect_failure(run_voxdag({"scene", "-o", path("x.ply")}), 2, "name");
  expect_failure(run_voxdag({"scene", "sponge", "-o", path("x.vdag")}), 2, "a mesh, FILE.ply");
  EXPECT_FALSE(exists("x.ply"));
}

TEST_F(Sponge, AFileThatGrowsTooLargeIsAClearErrorAndIsRemoved) {
  std::string command = "ulimit -f 1; exec";
  for (const std::string& word : voxdag_command({"scene", "sponge", "-o", path("x.ply")}))
    command += " '" + word + "'";
  expect_failure(Process({"bash", "-c", command}).wait(), 1, "x.ply: byte 1024: cannot write");
  EXPECT_EQ(files_like("x.ply"), 0);
}

TEST_F(Sponge, AStoppedSceneLeavesNothing) {
  Process process(voxdag_command({"scene", "hairball", "--size", "8000", "-o", path("x.ply")}));
  process.wait_until_it_catches(SIGTERM);
  process.send_signal(SIGTERM);
  EXPECT_EQ(process.wait().status, 128 + SIGTERM);
  EXPECT_EQ(files_like("x.ply"), 0);
}

TEST_F(Sponge, ASecondSignalLeavesNothingEither) {
  Process process(voxdag_command({"scene", "hairball", "--size", "8000", "-o", path("x.ply")}));
  process.wait_until_it_catches(SIGTERM);
  process.send_signal(SIGTERM);
  process.send_signal(SIGINT);
  EXPECT_GT(process.wait().status, 128);
  EXPECT_EQ(files_like("x.ply"), 0);
}

TEST_F(Sponge, TraceWritesOneHitForEachRay) {
  // The sponge has a vertical hole in the middle and walls beside it.
  const float up = std::numeric_limits<float>::infinity();
  const std::vector<std::array<float, 8>> rays = {{0.01F, 9, 0.01F, 0, 0, -1, 0, up},
                                                  {0.01F, 9, 0.01F, 0, 0, 1, 0, up},
                                                  {0.01F, 9, 0.01F, 0, 0, -1, 0, 1}};
  write_text(path("rays.npy"), rays_npy(rays));
  const ProcessResult result =
      run_voxdag({"trace", path("in.vdag"), "--rays", path("rays.npy"), "-o", path("hits.npy")});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("3 rays, 1 hits"), std::string::npos) << result.out;
  const std::string hits = read_text(path("hits.npy"));
  const std::size_t data = hits.size() - 3 * 18;
  EXPECT_EQ(data % 64, 0u);
  EXPECT_NE(hits.find("('voxel', '<i4', (3,))"), std::string::npos);
  EXPECT_EQ(hits[data + 16], 3);  // entered through +y
  EXPECT_EQ(hits[data + 17], 1);
  EXPECT_EQ(hits[data + 18 + 17], 0);
  EXPECT_EQ(hits[data + 36 + 17], 0);
}

TEST_F(Sponge, TraceTakesNoRaysAtAll) {
  write_text(path("none.npy"), rays_npy({}));
  EXPECT_EQ(run_voxdag({"trace", path("in.vdag"), "--rays", path("none.npy"), "-o", path("n.npy")})
                .status,
            0);
}

TEST_F(Sponge, TraceRefusesOtherArrays) {
  write_text(path("short.npy"), rays_npy({{}}).substr(0, 140));
  expect_failure(
      run_voxdag({"trace", path("in.vdag"), "--rays", path("short.npy"), "-o", path("h.npy")}), 1,
      "short.npy");
  EXPECT_FALSE(exists("h.npy"));
}

TEST_F(Sponge, ExportByExtension) {
  const auto run = [](std::vector<std::string> options) {
    options.insert(options.begin(), {"export", path("in.vdag"), "-o"});
    return run_voxdag(options);
  };
  EXPECT_EQ(run({path("all.npy")}).status, 0);
  EXPECT_EQ(run({path("points.ply")}).status, 0);
  EXPECT_EQ(run({path("faces.ply"), "--faces"}).status, 0);
  EXPECT_EQ(run({path("window.raw"), "--window", "0,0,0,8,4,2"}).status, 0);
  EXPECT_EQ(std::filesystem::file_size(path("window.raw")), 64u);
  expect_failure(run({path("voxels.xyz")}), 1, "voxels.xyz");
  expect_failure(run({path("w.npy"), "--window", "0,0,0,99,1,1"}), 1, "window");
  expect_failure(run({"/dev/full"}), 1, "/dev/full");
}

TEST_F(Sponge, InfoRefusesAFileThatIsNoDag) {
  expect_failure(run_voxdag({"info", path("sponge.ply")}), 1, "sponge.ply");
  expect_failure(run_voxdag({"info", path("absent.vdag")}), 1, "absent.vdag");
}

}  // namespace
}  // namespace voxdag::cli
