#include <fmt/core.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/process.hpp"
#include "support/temp_dir.hpp"

namespace voxdag::lab {
using namespace cli;
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Returns a wavy surface of 374 x 374 quadrilaterals: as many triangles as the paper's Crysponza
/// has, within its rounding.
std::string wavy_surface() {
  constexpr int kSide = 374;
  std::string obj;
  for (int y = 0; y <= kSide; ++y)
    for (int x = 0; x <= kSide; ++x) obj += fmt::format("v {} {} {}\n", x, y, x * y % 17);
  const auto index = [](int x, int y) { return y * (kSide + 1) + x + 1; };
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      obj += fmt::format("f {} {} {} {}\n", index(x, y), index(x + 1, y), index(x + 1, y + 1),
                         index(x, y + 1));
  return obj;
}

/// The scenes are Crysponza, whose name and number of triangles the surface has, and Lucy, which is
/// absent.
class BenchPapers : public testing::Test {
 protected:
  BenchPapers() { write_text(dir_ / "crysponza.obj", wavy_surface()); }

  static void TearDownTestSuite() { finished_.reset(); }

  /// Makes a report whose measurements are finished, in report_. Only the first call measures.
  void finish() {
    if (!finished_) {
      const ProcessResult result = run_voxdag(command());
      ASSERT_EQ(result.status, 0) << result.err;
      finished_ = std::make_unique<TempDir>();
      fs::copy(report_, finished_->path(), fs::copy_options::recursive);
    }
    fs::create_directories(report_);
    fs::copy(finished_->path(), report_,
             fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  }

  std::vector<std::string> command() const {
    return {"bench",    "papers", "--scenes",  dir_.path(), "--only",     "Crysponza,Lucy",
            "--table1", "32,512", "--table2",  "32,64",     "--pictures", "64",
            "--size",   "40x32",  "--figure1", "256",       "-o",         report_};
  }

  Json json() const { return Json::parse(read_text(fs::path(report_) / "report.json")); }
  std::string markdown() const { return read_text(fs::path(report_) / "report.md"); }

  TempDir dir_;
  std::string report_ = dir_ / "report";
  static inline std::unique_ptr<TempDir> finished_;
};

TEST_F(BenchPapers, SetsPublishedFiguresBesideThePapersScenes) {
  ASSERT_NO_FATAL_FAILURE(finish());
  const Json report = json(), &scenes = report.at("svdag").at("scenes");
  ASSERT_EQ(scenes.size(), 2u);
  EXPECT_EQ(scenes[0].at("scene"), "Crysponza");
  EXPECT_EQ(scenes[0].at("state"), "same");
  EXPECT_EQ(scenes[0].at("dags").size(), 2u);
  EXPECT_GT(scenes[0].at("esvos")[1].at("result").at("descriptors"), 0);
  EXPECT_GT(scenes[0].at("paper_method")[0].at("result").at("seconds").at("reduce"), 0);
  EXPECT_EQ(scenes[1].at("state"), "absent");
  const std::string text = markdown();
  EXPECT_NE(text.find("published, reduction | – | 8.4 ms |"), std::string::npos) << text;
  EXPECT_NE(text.find("| Lucy (absent) | published, reduction | – | 2.6 ms |"), std::string::npos)
      << text;
  EXPECT_NE(read_text(fs::path(report_) / "report.html").find("</html>"), std::string::npos);
  for (const char* picture : {"svdag-figure4-Crysponza.png", "svdag-figure8b-exact.png",
                              "svdag-figure8b-cones.png", "svdag-figure8b-difference.png"})
    EXPECT_TRUE(fs::exists(fs::path(report_) / picture)) << picture;
  for (const char* scratch : {"build.esvo", "picture.vdag", "picture.png"})
    EXPECT_FALSE(fs::exists(fs::path(report_) / scratch)) << scratch;
}

TEST_F(BenchPapers, MeasuresTheEsvoPapersScenes) {
  const char* const scenes_folder = std::getenv("VOXDAG_SCENES");
  if (scenes_folder == nullptr || !fs::exists(fs::path(scenes_folder) / "sibenik"))
    GTEST_SKIP() << "VOXDAG_SCENES has no sibenik";
  const ProcessResult result =
      run_voxdag({"bench", "papers", "--scenes", fs::path(scenes_folder) / "sibenik", "--only",
                  "Sibenik,Sibenik-D", "--esvo-tables", "16,32", "--esvo-pictures", "32", "--size",
                  "40x32", "-o", report_});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json report = json(), &scenes = report.at("esvo").at("scenes");
  ASSERT_EQ(scenes.size(), 2u);
  EXPECT_EQ(scenes[1].at("scene"), "Sibenik-D");
  EXPECT_EQ(scenes[1].at("state"), "variant");
  for (const Json& scene : scenes) {
    EXPECT_GT(scene.at("builds")[1].at("result").at("voxels"), 0);
    EXPECT_GT(scene.at("rays")[1].at("result").at("rays")[0].at("filter_seconds"), 0);
  }
  const std::string text = markdown();
  for (const char* line : {"Figure 1: ", "Figures 4 and 5: ", "Figure 9: ", "Figure 10: ",
                           "Figure 11: ", "Figure 12: ", "--filter-kind plain",
                           "--filter-kind guided", "Sibenik-D (variant)", "stone:0.15:4"})
    EXPECT_NE(text.find(line), std::string::npos) << line;
  for (const char* picture :
       {"esvo-figure1.png", "esvo-figure4-64-cubes.png", "esvo-figure4-64-contours.png",
        "esvo-figure9-beams.png", "esvo-figure10-naive.png", "esvo-figure10-adaptive.png",
        "esvo-figure11-plain.png", "esvo-figure11-guided.png", "esvo-figure12-Sibenik.png"})
    EXPECT_TRUE(fs::exists(fs::path(report_) / picture)) << picture;
  EXPECT_FALSE(fs::exists(fs::path(report_) / "picture.esvo"));
}

TEST_F(BenchPapers, FliesThroughASceneThatHasACameraPath) {
  const char* const scenes = std::getenv("VOXDAG_SCENES");
  if (scenes == nullptr || !fs::exists(fs::path(scenes) / "crytek_sponza" / "sponza.obj"))
    GTEST_SKIP() << "VOXDAG_SCENES has no crytek_sponza/sponza.obj";
  std::vector<std::string> arguments = command();
  arguments[3] = fs::path(scenes) / "crytek_sponza";
  for (const char* option : {"--flight-esvo=64", "--flight-triangles=128", "--frames=3"})
    arguments.emplace_back(option);
  const ProcessResult result = run_voxdag(arguments);
  ASSERT_EQ(result.status, 0) << result.err;
  const Json flight = json().at("svdag").at("flight");
  EXPECT_EQ(flight.at("scene"), "Crysponza");
  const Json figure1 = json().at("svdag").at("figure1");
  EXPECT_EQ(figure1.at("scene"), "Crysponza");
  EXPECT_EQ(figure1.at("build").at("resolution"), 256);
  EXPECT_GT(figure1.at("rays").at("rows").at(0).at("mrays_per_s"), 0);
  EXPECT_TRUE(fs::exists(fs::path(report_) / "svdag-figure1.png"));
  for (const char* run : {"with_esvo", "with_triangles", "with_voxels", "with_cones"})
    for (const Json& row : flight.at(run).at("rows"))
      EXPECT_EQ(row.at("view_mrays_per_s").size(), 3u) << run;
  for (const char* figure : {"Figure 1: ", "Figure 6: ", "Figure 7a: ", "Figure 8a: "})
    EXPECT_NE(markdown().find(figure), std::string::npos) << figure;
  EXPECT_FALSE(fs::exists(fs::path(report_) / "fine.vdag"));
}

TEST_F(BenchPapers, KeepsFinishedMeasurements) {
  ASSERT_NO_FATAL_FAILURE(finish());
  const Json first = json();
  const ProcessResult again = run_voxdag(command());
  EXPECT_NE(again.out.find(": 0 measured, "), std::string::npos) << again.out;
  for (const char* paper : {"svdag", "esvo"}) EXPECT_EQ(json().at(paper), first.at(paper));
  fs::remove(fs::path(report_) / "svdag-figure8b-cones.png");
  const ProcessResult painted = run_voxdag(command());
  EXPECT_NE(painted.out.find(": 1 measured, "), std::string::npos) << painted.out;
  EXPECT_TRUE(fs::exists(fs::path(report_) / "svdag-figure8b-cones.png"));
}

TEST_F(BenchPapers, MeasuresAgainWhatIsDamaged) {
  ASSERT_NO_FATAL_FAILURE(finish());
  for (const auto& cell : fs::directory_iterator(fs::path(report_) / "cells")) {
    write_text(cell.path(), "{\"result\": ");
    break;
  }
  const ProcessResult again = run_voxdag(command());
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_NE(again.out.find(": 1 measured, "), std::string::npos) << again.out;
}

TEST_F(BenchPapers, ALimitThatIsTooLowIsReported) {
  std::vector<std::string> limited = command();
  limited.insert(limited.end(), {"--memory", "1M"});
  const ProcessResult result = run_voxdag(limited);
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(markdown().find("Crysponza at 32³: "), std::string::npos) << markdown();
  EXPECT_NE(markdown().find("memory limit"), std::string::npos) << markdown();
}

TEST_F(BenchPapers, AnInterruptedRunContinues) {
  Process interrupted(voxdag_command(command()));
  const fs::path cells = fs::path(report_) / "cells";
  const bool has_begun =
      interrupted.wait_until([&] { return fs::exists(cells) && !fs::is_empty(cells); });
  interrupted.send_signal(SIGTERM);
  const ProcessResult result = interrupted.wait();
  ASSERT_TRUE(has_begun) << result.err;
  EXPECT_EQ(result.status, 128 + SIGTERM);
  const ProcessResult again = run_voxdag(command());
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(again.out.find(", 0 kept"), std::string::npos) << again.out;
}

TEST_F(BenchPapers, AnUnknownSceneIsRefused) {
  const ProcessResult result =
      run_voxdag({"bench", "papers", "--only", "Teapot", "-o", dir_ / "report"});
  EXPECT_EQ(result.status, 2);
  EXPECT_NE(result.err.find("must be one of"), std::string::npos) << result.err;
}

TEST_F(BenchPapers, AFolderOfScenesThatDoesNotExistIsAnError) {
  const ProcessResult result =
      run_voxdag({"bench", "papers", "--scenes", dir_ / "none", "-o", dir_ / "report", "-q"});
  expect_failure(result, 1, "none");
}

}  // namespace
}  // namespace voxdag::lab
