#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/process.hpp"
#include "support/temp_dir.hpp"

namespace voxdag::lab {
using namespace cli;
namespace {

using Json = nlohmann::json;

/// A tetrahedron.
constexpr const char* kMesh =
    "v 1 2 3\nv 5 2 3\nv 1 4 3\nv 1 2 5\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

class BenchBuild : public testing::Test {
 protected:
  BenchBuild() { write_text(mesh_, kMesh); }

  ProcessResult bench(std::vector<std::string> options) const {
    options.insert(options.begin(), {"bench", "build"});
    return run_voxdag(options);
  }

  TempDir dir_;
  std::string mesh_ = dir_ / "lucy.obj";  // a name in the paper's table
};

TEST_F(BenchBuild, JsonHasTheCostOfEachBuild) {
  const ProcessResult result =
      bench({mesh_, "-r", "128,32", "--method", "hash,sort", "--threads", "1", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json json = Json::parse(result.out);
  EXPECT_GT(json.at("machine").at("cores"), 0);
  const Json& builds = json.at("builds");
  ASSERT_EQ(builds.size(), 4u);
  for (const Json& build : builds) {
    for (const char* key : {"wall_seconds", "cpu_seconds", "peak_memory_bytes", "voxels",
                            "voxels_per_second", "dag_nodes", "dag_bytes", "memory_ratio"})
      EXPECT_GT(build.at(key), 0) << key;
    for (const char* stage :
         {"read", "quantize", "voxelize", "merge", "reduce", "sort", "canonical", "write"})
      EXPECT_GE(build.at("stage_seconds").at(stage), 0) << stage;
    EXPECT_EQ(build.at("scene"), "lucy.obj");
    EXPECT_EQ(build.at("triangles"), 4);
    EXPECT_EQ(build.at("threads"), 1);
  }
  EXPECT_EQ(builds[0].at("resolution"), 32);
  EXPECT_EQ(builds[1].at("resolution"), 128);
  EXPECT_EQ(builds[1].at("voxels"), builds[3].at("voxels"));
}

TEST_F(BenchBuild, GrowthIsPerLevel) {
  const Json json = Json::parse(bench({mesh_, "-r", "32,128", "--json"}).out);
  const Json& builds = json.at("builds");
  EXPECT_FALSE(builds[0].contains("growth_per_level"));
  const double factor = builds[1].at("voxels").get<double>() / builds[0].at("voxels").get<double>();
  EXPECT_DOUBLE_EQ(builds[1].at("growth_per_level").at("voxels"), std::sqrt(factor));
}

TEST_F(BenchBuild, AMeshWithANameOfThePaperIsNotItsScene) {
  const Json json = Json::parse(bench({mesh_, "-r", "512", "--method", "paper", "--json"}).out);
  EXPECT_FALSE(json.at("builds")[0].contains("published"));
  EXPECT_FALSE(json.at("builds")[0].contains("paper_scene"));
}

TEST_F(BenchBuild, AProceduralStandInIsNamedAndHasNoPublishedFigures) {
  const Json json =
      Json::parse(bench({"hairball:20", "-r", "512", "--method", "paper", "--json"}).out);
  EXPECT_EQ(json.at("builds")[0].at("paper_scene").at("state"), "stand-in");
  EXPECT_FALSE(json.at("builds")[0].contains("published"));
}

TEST_F(BenchBuild, OnlyThePapersMethodStandsBesideThePapersSeconds) {
  const char* const scenes = std::getenv("VOXDAG_SCENES");
  if (scenes == nullptr) GTEST_SKIP() << "VOXDAG_SCENES is not set";
  const std::string lucy = std::string(scenes) + "/scans/lucy.ply";
  const Json json = Json::parse(bench({lucy, "-r", "512", "--method", "paper,sort", "--json"}).out);
  const Json& by_paper = json.at("builds")[0];
  EXPECT_EQ(by_paper.at("paper_scene").at("state"), "variant");
  EXPECT_EQ(by_paper.at("published").at("reduce_seconds"), 0.0026);
  // The seconds of `sort` are sums over threads.
  EXPECT_EQ(json.at("builds")[1].at("method"), "sort");
  EXPECT_FALSE(json.at("builds")[1].contains("published"));
}

TEST_F(BenchBuild, TableJsonFileAndPlotComeFromOneRun) {
  const std::string json = dir_ / "out.json", plot = dir_ / "out.svg";
  const ProcessResult result = bench({mesh_, "-r", "32,64", "-o", json, "--plot", plot});
  if (lacks_matplotlib(result)) GTEST_SKIP() << "matplotlib is not installed";
  ASSERT_EQ(result.status, 0) << result.err;
  for (const char* text : {"lucy.obj", "wall s", "CPU s", "voxels/s", "peak mem", "growth"})
    EXPECT_NE(result.out.find(text), std::string::npos) << text;
  EXPECT_EQ(Json::parse(read_text(json)).at("builds").size(), 2u);
  EXPECT_NE(read_text(plot).find("<svg"), std::string::npos);
}

TEST_F(BenchBuild, ARivalIsMeasuredInTheSameRun) {
  const ProcessResult result =
      bench({mesh_, "-r", "64", "--json", "--rival",
             "copy=cp {mesh} {out} && echo '{\"grid\": {resolution}, \"levels\": {levels}}'"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json rivals = Json::parse(result.out).at("rivals");
  ASSERT_EQ(rivals.size(), 1u);
  EXPECT_EQ(rivals[0].at("name"), "copy");
  EXPECT_EQ(rivals[0].at("output_bytes"), std::string(kMesh).size());
  EXPECT_EQ(rivals[0].at("reported"), Json({{"grid", 64}, {"levels", 6}}));
  EXPECT_GT(rivals[0].at("peak_memory_bytes"), 0);
}

TEST_F(BenchBuild, ARivalThatFailsOrHangsIsRecorded) {
  const ProcessResult result =
      bench({mesh_, "-r", "16,32", "--json", "--rival", "fails=echo broken >&2; exit 3",  //
             "--rival", "hangs=sleep 100", "--rival-seconds", "0.2"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json rivals = Json::parse(result.out).at("rivals");
  ASSERT_EQ(rivals.size(), 2u);  // the higher resolution is skipped
  EXPECT_EQ(rivals[0].at("failure"), "broken");
  EXPECT_EQ(rivals[1].at("failure"), "stopped at the time limit of 0.2 s");
}

TEST_F(BenchBuild, AProceduralSceneIsGeneratedForTheRun) {
  const ProcessResult result = bench({"sponge:2", "-r", "64", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json builds = Json::parse(result.out).at("builds");
  ASSERT_EQ(builds.size(), 1u);
  EXPECT_EQ(builds[0].at("scene"), "sponge:2");
  EXPECT_GT(builds[0].at("voxels"), 0);
}

TEST_F(BenchBuild, MeshesMayNameOtherFilesIfThatIsAllowed) {
  std::filesystem::create_directory(dir_ / "inside");
  write_text(dir_ / "three.bin", std::string(36, '\0'));
  write_text(
      dir_ / "inside/a.gltf",
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[)"
      R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"bufferViews":)"
      R"([{"buffer":0,"byteLength":36}],"buffers":[{"uri":"../three.bin","byteLength":36}]})");
  const std::vector<std::string> options{dir_ / "inside/a.gltf", "-r", "64"};
  ProcessResult refused = bench(options);
  refused.out.clear();  // the table, without figures
  expect_failure(refused, 1, "three.bin");
  std::vector<std::string> allowed = options;
  allowed.emplace_back("--allow-outside");
  EXPECT_EQ(bench(allowed).status, 0);
}

TEST_F(BenchBuild, AKilledBenchmarkLeavesNoScratchFolder) {
  const TempDir scratch;
  std::vector<std::string> command =
      voxdag_command({"bench", "build", mesh_, "-r", "64", "--rival", "slow=sleep 60"});
  command.insert(command.begin(), {"env", "TMPDIR=" + scratch.path().string()});
  Process process(command);
  // Python also tries whether it can write a file there, which stays if it is killed meanwhile.
  const auto has_folder = [&] {
    const std::filesystem::directory_iterator entries(scratch.path());
    return std::any_of(begin(entries), end(entries),
                       [](const auto& entry) { return entry.is_directory(); });
  };
  const bool has_begun = process.wait_until(has_folder);
  process.send_signal(SIGKILL);
  const ProcessResult killed = process.wait();
  ASSERT_TRUE(has_begun) << killed.err;
  while (has_folder()) usleep(1000);  // ctest's time limit is the limit
}

TEST(BenchConformance, RowsAreThoseOfTheTable) {
  const ProcessResult result = run_voxdag({"bench", "conformance", "--scene", "terrain"});
  EXPECT_EQ(result.status, 0) << result.out << result.err;
  EXPECT_EQ(result.out, "voxdag: all 4 rows are those of the table\n");
  const TempDir dir;
  write_text(dir / "mine.csv", "scene,grid,voxels\nsponge,64,1\n");
  const ProcessResult wrong = run_voxdag({"bench", "conformance", "--check", dir / "mine.csv"});
  EXPECT_EQ(wrong.status, 1);
  EXPECT_NE(wrong.out.find("sponge at 64³: voxels is 1, in the table "), std::string::npos);
}

TEST(BenchUntrusted, RunsACaseAndNamesWhatItCost) {
  const ProcessResult result =
      run_voxdag({"bench", "untrusted", "--only", "every face 1,000 times: ESVO", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json cases = Json::parse(result.out).at("cases");
  ASSERT_EQ(cases.size(), 1u);
  EXPECT_EQ(cases[0].at("failure"), "");
  EXPECT_GT(cases[0].at("peak_bytes"), 0);
  expect_failure(run_voxdag({"bench", "untrusted", "--only", "no such case"}), 1, "no such case");
}

TEST_F(BenchBuild, BadInputIsRefused) {
  expect_failure(bench({dir_ / "absent.obj", "-r", "64"}), 1, "absent.obj");
  expect_failure(bench({mesh_, "-r", "63"}), 2, "64");
  expect_failure(bench({mesh_, "-r", "64", "--rival", "nonsense"}), 2, "NAME=COMMAND");
  expect_failure(bench({mesh_, "-r", "64", "-o", dir_ / "no/such/out.json"}), 1, "no/such");
  write_text(mesh_, "v 1 2 3\nf 1 2 3\n");
  ProcessResult result = bench({mesh_, "-r", "64"});
  result.out.clear();  // the table, without figures
  expect_failure(result, 1, "line 2");
}

}  // namespace
}  // namespace voxdag::lab
