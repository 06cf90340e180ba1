#include <nlohmann/json.hpp>

#include "cli/sponge.hpp"

namespace voxdag::lab {
using namespace cli;
namespace {

using Json = nlohmann::json;

class BenchCompact : public Sponge {};

TEST_F(BenchCompact, JsonHasTheBytesOfEveryForm) {
  const ProcessResult result =
      run_voxdag({"bench", "compact", path("sponge.ply"), "-r", "16,32", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json json = Json::parse(result.out);
  ASSERT_EQ(json.at("runs").size(), 2u);
  const Json info = Json::parse(run_voxdag({"info", path("in.vdag"), "--json"}).out);
  const Json& run = json.at("runs")[1];
  EXPECT_EQ(run.at("scene"), "sponge.ply");
  EXPECT_EQ(run.at("resolution"), 32);
  EXPECT_EQ(run.at("voxels"), info.at("voxels"));
  EXPECT_EQ(run.at("forms").at("svo").at("bytes"), run.at("svo_nodes"));
  EXPECT_EQ(run.at("forms").at("svdag").at("of_svdag"), 1);
  for (const auto& [key, form] : run.at("forms").items()) {
    std::uint64_t sum = 0;
    for (const auto& [part, bytes] : form.at("parts").items()) sum += bytes.get<std::uint64_t>();
    EXPECT_EQ(form.at("bytes"), sum) << key;
    EXPECT_GE(form.at("seconds"), 0) << key;
    EXPECT_EQ(json.at("geometric_means").at(key).at("runs"), 2) << key;
  }
}

TEST_F(BenchCompact, AFileKeepsItsResolution) {
  const ProcessResult result =
      run_voxdag({"bench", "compact", path("in.vdag"), "--forms", "tsvdag,ssvdag"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("sponge.ply"), std::string::npos) << result.out;
  const std::size_t ssvdag = result.out.find(" SSVDAG "), tsvdag = result.out.find(" TSVDAG ");
  EXPECT_LT(ssvdag, tsvdag) << result.out;
  EXPECT_NE(tsvdag, std::string::npos) << result.out;
  EXPECT_EQ(result.out.find(" SVO "), std::string::npos) << result.out;
}

TEST_F(BenchCompact, AFileInTheCompactFormHasTheSameBytes) {
  ASSERT_EQ(run_voxdag({"convert", path("in.vdag"), "--compact", "-o", path("c.vdag")}).status, 0);
  const auto bytes_of = [&](const char* file) {
    const ProcessResult result =
        run_voxdag({"bench", "compact", path(file), "--forms", "svdag,voxdag", "--json"});
    EXPECT_EQ(result.status, 0) << result.err;
    return Json::parse(result.out).at("runs")[0].at("forms").at("voxdag").at("bytes");
  };
  EXPECT_EQ(bytes_of("c.vdag"), bytes_of("in.vdag"));
}

TEST_F(BenchCompact, RaysAreCastAtTheCompactFormWithFewAndManyTables) {
  const ProcessResult result = run_voxdag({"bench", "compact-rays", path("in.vdag"), "--views", "1",
                                           "--repeat", "1", "--rays", "500", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json json = Json::parse(result.out);
  EXPECT_GT(json.at("rays").at("primary"), 0);
  ASSERT_EQ(json.at("compact").size(), 6u);
  EXPECT_EQ(json.at("compact")[0].at("tables"), 1);
  for (const Json& point : json.at("compact")) {
    EXPECT_GT(point.at("bytes"), 0);
    EXPECT_GT(point.at("primary").at("seconds"), 0);
    EXPECT_GT(point.at("primary").at("packet_seconds"), 0);
    EXPECT_GT(point.at("primary").at("decoded_per_ray"), 0);
  }
  const auto reads = [](const Json& counts, const char* what) {
    return counts.at(what).get<double>();
  };
  const Json& plain = json.at("plain_reads_per_ray").at("ao");
  EXPECT_EQ(reads(plain, "symbols"), 0);
  EXPECT_GE(reads(plain, "bytes"), 4 * reads(plain, "lines"));
  EXPECT_LE(reads(plain, "bytes"), 64 * reads(plain, "lines"));
  const Json few = json.at("compact")[0].at("ao").at("reads_per_ray"),
             many = json.at("compact")[5].at("ao").at("reads_per_ray");
  EXPECT_GT(reads(few, "symbols"), 1);
  EXPECT_EQ(reads(few, "symbols"), reads(many, "symbols"));
  EXPECT_GT(reads(many, "bytes"), 0);
}

TEST_F(BenchCompact, AnUnknownFormIsBadUsage) {
  expect_failure(run_voxdag({"bench", "compact", path("in.vdag"), "--forms", "zip"}), 2,
                 "svo, svdag, ssvdag, tsvdag, voxdag");
}

TEST_F(BenchCompact, TheOtherScenesAreMeasuredIfOneFails) {
  const ProcessResult result = run_voxdag(
      {"bench", "compact", path("none.vdag"), path("in.vdag"), "--forms", "svo", "--json"});
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("none.vdag"), std::string::npos) << result.err;
  const Json runs = Json::parse(result.out).at("runs");
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_TRUE(runs[0].contains("failure"));
  EXPECT_TRUE(runs[1].contains("forms"));
}

TEST_F(BenchCompact, ThePlotHasAPanelForEachResolution) {
  const ProcessResult result = run_voxdag({"bench", "compact", path("sponge.ply"), "-r", "16,32",
                                           "--forms", "svdag,ssvdag", "--plot", path("c.svg")});
  if (result.status != 0 && result.err.find("matplotlib") != std::string::npos)
    GTEST_SKIP() << "matplotlib is not installed";
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(exists("c.svg"));
}

}  // namespace
}  // namespace voxdag::lab
