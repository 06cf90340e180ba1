#include <cstdlib>
#include <nlohmann/json.hpp>

#include "cli/sponge.hpp"

namespace voxdag::lab {
using namespace cli;
namespace {

using Json = nlohmann::json;

class BenchEsvo : public Sponge {
 protected:
  static ProcessResult bench(std::vector<std::string> options) {
    const std::vector<std::string> start = {"bench",    "esvo", "--size",  "40x32,80x64",
                                            "--repeat", "1",    "--views", "2"};
    options.insert(options.begin(), start.begin(), start.end());
    return run_voxdag(options);
  }
};

TEST_F(BenchEsvo, JsonHasBothFormsOfEveryResolution) {
  const ProcessResult result = bench({"Sponge=" + path("sponge.ply"), "-r", "64,16", "--threads",
                                      "1", "--no-silhouettes", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json json = Json::parse(result.out);
  const Json& builds = json.at("builds");
  ASSERT_EQ(builds.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(builds[i].at("scene"), "Sponge");
    EXPECT_EQ(builds[i].at("resolution"), i < 2 ? 16 : 64);
    EXPECT_EQ(builds[i].at("contours"), i % 2 == 0);
    for (const char* key : {"voxels", "bytes", "bytes_per_voxel", "build_seconds", "cpu_seconds",
                            "voxels_per_second", "voxels_per_cpu_second", "peak_memory_bytes"})
      EXPECT_GT(builds[i].at(key), 0) << key;
    EXPECT_FALSE(builds[i].contains("paper"));
  }
  // The sides of the mesh are parallel to the axes, so leaves with contours are coarse.
  EXPECT_LT(builds[2].at("voxels"), builds[3].at("voxels"));
  ASSERT_EQ(json.at("rays").size(), 2u);
  for (const Json& row : json.at("rays")) {
    EXPECT_EQ(row.at("resolution"), 64);
    EXPECT_GT(row.at("ray_count"), 0);
    for (const char* form : {"cubes", "contours", "contours_beams"})
      EXPECT_GT(row.at(form).at("mrays_per_s"), 0) << form;
    // No silhouettes were measured, so no coarse grid is known.
    EXPECT_TRUE(row.at("coarse_resolution").is_null());
    EXPECT_TRUE(row.at("coarse_contours").at("mrays_per_s").is_null());
  }
}

TEST_F(BenchEsvo, AMeshWithANameOfThePaperIsNotItsScene) {
  write_text(path("sliver.obj"), "v 0 0 0\nv 1 0.2 0.1\nv 0 0.05 0\nf 1 2 3\n");
  const ProcessResult result = bench({"sibenik=" + path("sliver.obj"), "-r", "1K", "--size",
                                      "512x384", "--no-silhouettes", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json json = Json::parse(result.out);
  EXPECT_FALSE(json.at("builds")[0].contains("paper"));
  EXPECT_TRUE(json.at("rays").back().at("contours_beams").at("paper_mrays_per_s").is_null());
  EXPECT_TRUE(json.at("silhouettes").empty());
}

TEST_F(BenchEsvo, AVariantOfASceneOfThePaperStandsBesideItsFiguresOfEqualDepth) {
  const char* const scenes = std::getenv("VOXDAG_SCENES");
  if (scenes == nullptr) GTEST_SKIP() << "VOXDAG_SCENES is not set";
  const ProcessResult result =
      bench({"cathedral=" + std::string(scenes) + "/sibenik/sibenik.obj", "-r", "1K", "--size",
             "512x384", "--no-silhouettes", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json json = Json::parse(result.out);
  EXPECT_EQ(json.at("builds")[0].at("paper_scene").at("name"), "Sibenik");
  EXPECT_EQ(json.at("builds")[0].at("paper_scene").at("state"), "variant");
  EXPECT_EQ(json.at("builds")[0].at("paper").at("megabytes"), 41);
  EXPECT_EQ(json.at("builds")[0].at("paper").at("build_seconds"), 10);
  // The paper's rates are of an octree of 14 levels.
  EXPECT_TRUE(json.at("rays").back().at("contours_beams").at("paper_mrays_per_s").is_null());
}

TEST_F(BenchEsvo, SilhouettesAreComparedWithTheMesh) {
  const ProcessResult result = bench({"Sponge=" + path("sponge.ply"), "-r", "16,32,64", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json json = Json::parse(result.out);
  if (json.at("rays").at(0).at("triangles").at("mrays_per_s").is_null())
    GTEST_SKIP() << "built without Embree";
  const Json& rows = json.at("silhouettes");
  ASSERT_EQ(rows.size(), 3u);
  for (const Json& row : rows) EXPECT_LE(row.at("contours_wrong"), row.at("cubes_wrong"));
  EXPECT_LT(rows[2].at("cubes_wrong"), rows[0].at("cubes_wrong"));

  // The coarsest grid that is as good as the finest cubes.
  std::size_t coarse = 0;
  while (rows[coarse].at("contours_wrong") > rows[2].at("cubes_wrong")) ++coarse;
  ASSERT_LT(coarse, 2u);
  for (const Json& row : json.at("rays")) {
    EXPECT_EQ(row.at("resolution"), 64);
    EXPECT_EQ(row.at("coarse_resolution"), rows[coarse].at("resolution"));
    for (const char* form : {"coarse_contours", "coarse_contours_beams"})
      EXPECT_GT(row.at(form).at("mrays_per_s"), 0) << form;
  }
}

TEST_F(BenchEsvo, TablesAndDiagramsAreWritten) {
  const ProcessResult result = bench({"sponge=sponge:2", "-r", "16,32", "-o", path("esvo.json"),
                                      "--plot", path("esvo.svg"), "--rays-plot", path("rays.svg")});
  if (lacks_matplotlib(result)) GTEST_SKIP() << "matplotlib is not installed";
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("contours_beams"), std::string::npos);
  EXPECT_EQ(Json::parse(read_text(path("esvo.json"))).at("builds").size(), 4u);
  for (const char* file : {"esvo.svg", "rays.svg"})
    EXPECT_NE(read_text(path(file)).find("<svg"), std::string::npos) << file;
}

TEST_F(BenchEsvo, FailuresSayWhatIsWrong) {
  expect_failure(bench({"Sponge"}), 2, "NAME=MESH");
  expect_failure(bench({"Sponge=" + path("sponge.ply"), "-r", "63"}), 2, "63");
  expect_failure(bench({"Sponge=" + path("absent.ply")}), 1, "absent.ply");
  const ProcessResult result =
      bench({"Sponge=" + path("sponge.ply") + " --max-error nonsense", "-r", "16"});
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("Sponge: 16: --max-error"), std::string::npos) << result.err;
  EXPECT_NE(result.out.find("failed: --max-error"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace voxdag::lab
