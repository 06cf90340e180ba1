#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/colored_waves.hpp"
#include "cli/process.hpp"
#include "support/temp_dir.hpp"

namespace voxdag::lab {
using namespace cli;
namespace {

using Json = nlohmann::json;

class BenchAttributes : public testing::Test {
 protected:
  void SetUp() override { std::ofstream(path("waves.obj")) << colored_waves(); }
  std::string path(const std::string& name) const { return dir_ / name; }

  TempDir dir_;
};

TEST_F(BenchAttributes, JsonHasTheRateAndTheErrorOfEveryCodec) {
  const ProcessResult result =
      run_voxdag({"bench", "attributes", path("waves.obj"), "-r", "64", "--bounds", "0,0.05",
                  "--thresholds", "0.05", "--views", "1", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json json = Json::parse(result.out);
  ASSERT_EQ(json.at("runs").size(), 1u);
  ASSERT_EQ(run_voxdag({"build", path("waves.obj"), "-r", "64", "--color", "--color-bound", "0.05",
                        "-o", path("a.vdag")})
                .status,
            0);
  const Json info = Json::parse(run_voxdag({"info", path("a.vdag"), "--json"}).out);
  const Json& run = json.at("runs")[0];
  EXPECT_EQ(run.at("scene"), "waves.obj");
  EXPECT_EQ(run.at("resolution"), 64);
  EXPECT_EQ(run.at("voxels"), info.at("voxels"));
  EXPECT_EQ(run.at("index_bytes"), info.at("attributes").at("index_bytes"));
  const Json& results = run.at("results");
  ASSERT_EQ(results.size(), 4u);
  EXPECT_EQ(results[0].at("psnr_db"), Json());
  EXPECT_NEAR(results[0].at("mean_ms_ssim"), 1, 1e-9);
  const Json& stored = info.at("attributes").at("color");
  EXPECT_EQ(results[1].at("bytes"), stored.at("bytes"));
  EXPECT_NEAR(results[1].at("psnr_db"), stored.at("psnr_db"), 1e-6);
  EXPECT_NEAR(results[1].at("bits_per_voxel"),
              8 * stored.at("bytes").get<double>() / info.at("voxels").get<double>(), 1e-9);
  EXPECT_EQ(results[2].at("codec"), "dolonius");
  EXPECT_EQ(results[3].at("codec"), "esvo");
  for (const Json& colors : results) {
    EXPECT_GT(colors.at("bytes"), 0);
    EXPECT_GT(colors.at("mean_ms_ssim"), 0.5);
    EXPECT_EQ(colors.at("ms_ssim").size(), 1u);
    EXPECT_GT(colors.at("cells_per_second"), 0);
  }
}

TEST_F(BenchAttributes, TheOtherScenesAreMeasuredIfOneFails) {
  const ProcessResult result =
      run_voxdag({"bench", "attributes", path("none.obj"), path("waves.obj"), "-r", "16",
                  "--codecs", "esvo", "--views", "1"});
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("none.obj"), std::string::npos) << result.err;
  EXPECT_NE(result.out.find("none.obj failed"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("ESVO blocks"), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find("Dolonius"), std::string::npos) << result.out;
}

TEST_F(BenchAttributes, WrongListsAreBadUsage) {
  expect_failure(run_voxdag({"bench", "attributes", path("waves.obj"), "--codecs", "zip"}), 2,
                 "voxdag, dolonius, esvo");
  expect_failure(run_voxdag({"bench", "attributes", path("waves.obj"), "--bounds", "0.1,2"}), 2,
                 "from 0 to 1");
}

TEST_F(BenchAttributes, ThePlotIsDrawn) {
  const ProcessResult result = run_voxdag({"bench", "attributes", path("waves.obj"), "-r", "16",
                                           "--views", "1", "--plot", path("a.svg")});
  if (result.status != 0 && result.err.find("matplotlib") != std::string::npos)
    GTEST_SKIP() << "matplotlib is not installed";
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(std::filesystem::exists(path("a.svg")));
}

}  // namespace
}  // namespace voxdag::lab
