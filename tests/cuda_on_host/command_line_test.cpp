/// Runs the command line with the host device: `--device cuda` gives the results of `--device cpu`.
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/npy_rays.hpp"
#include "cli/sponge.hpp"

namespace voxdag::cli {
namespace {

class DeviceCommands : public Sponge {
 protected:
  static void SetUpTestSuite() {
    Sponge::SetUpTestSuite();
    ASSERT_EQ(run_voxdag({"build", path("sponge.ply"), "-r", "32", "-o", path("in.esvo")}).status,
              0);
    write_text(path("rays.npy"), rays_npy({{0.01F, 9, 0.01F, 0, 0, -1, 0, HUGE_VALF},
                                           {9, 9, 9, 0, 0, 1, 0, HUGE_VALF}}));
  }

  /// Runs the command on a device.
  static ProcessResult run_on(const char* device, std::vector<std::string> words) {
    words.insert(words.end(), {"--device", device});
    return run_voxdag(words);
  }
  /// Expects the command to write the same file `output` on both devices.
  static void expect_like_cpu(std::vector<std::string> words, const std::string& output) {
    const ProcessResult cpu = run_on("cpu", words);
    ASSERT_EQ(cpu.status, 0) << cpu.err;
    const std::string expected = read_text(path(output));
    for (const char* device : {"cuda", "cuda:0", "auto"}) {
      const ProcessResult cuda = run_on(device, words);
      ASSERT_EQ(cuda.status, 0) << cuda.err;
      EXPECT_NE(cuda.out.find(" on the host\n"), std::string::npos) << cuda.out;
      EXPECT_TRUE(read_text(path(output)) == expected) << words[0] << " " << words[1];
    }
  }
};

TEST_F(DeviceCommands, TraceFindsTheHitsOfTheCpu) {
  for (const char* scene : {"in.vdag", "in.esvo"})
    expect_like_cpu({"trace", path(scene), "--rays", path("rays.npy"), "-o", path("hits.npy")},
                    "hits.npy");
}

TEST_F(DeviceCommands, RenderMakesThePictureOfTheCpu) {
  for (const char* scene : {"in.vdag", "in.esvo"})
    for (const std::vector<std::string>& options :
         {std::vector<std::string>{"--no-filter"},
          {"--filter", "--spp", "2"},
          {"--filter-kind", "plain", "--ao", "8"},
          {"--filter-kind", "naive", "--ao", "8"},
          {"--light", "sphere:1,3,1,0.2", "--ao", "8", "--lod", "2"},
          {"--sun-angle", "0", "--no-beams", "--pass", "steps=" + path("steps.png")}}) {
      std::vector<std::string> words = {"render",      path(scene), "-o",
                                        path("p.exr"), "--size",    "50x30"};
      words.insert(words.end(), options.begin(), options.end());
      expect_like_cpu(words, "p.exr");
    }
}

TEST_F(DeviceCommands, StreamedPicturesAndFilmsAreThoseOfTheCpu) {
  for (const std::string memory : {"1M", "1G"}) {
    expect_like_cpu({"render", path("in.esvo"), "-o", path("s.exr"), "--size", "50x30", "--memory",
                     memory, "--ao", "8"},
                    "s.exr");
    write_text(path("keys.json"),
               R"({"keys": [{"time": 0, "eye": [3, 2, 5], "target": [1, 1, 1]},
                            {"time": 1, "eye": [5, 2, 3], "target": [1, 1, 1]}]})");
    const std::vector<std::string> film = {
        "render",          path("in.esvo"), "-o", path("f%d.exr"), "--size", "20x12", "--path",
        path("keys.json"), "--fps",         "2",  "--memory",      memory};
    ASSERT_EQ(run_on("cpu", film).status, 0);
    const std::string first = read_text(path("f0.exr")), last = read_text(path("f2.exr"));
    const ProcessResult cuda = run_on("cuda", film);
    ASSERT_EQ(cuda.status, 0) << cuda.err;
    EXPECT_TRUE(read_text(path("f0.exr")) == first && read_text(path("f2.exr")) == last);
  }
}

TEST_F(DeviceCommands, BenchTraceMeasuresItAtEveryLayout) {
  for (const auto& [scene, layouts] :
       {std::pair{"in.vdag", std::vector<std::string>{"paper", "wide"}},
        {"in.esvo", {"contours", "cubes"}}}) {
    const ProcessResult result = run_on(
        "cuda", {"bench", "trace", path(scene), "--size", "40x32", "--repeat", "1", "--views", "1",
                 "--layout", fmt::format("{}", fmt::join(layouts, ",")), "--json"});
    ASSERT_EQ(result.status, 0) << result.err;
    const nlohmann::json rows = nlohmann::json::parse(result.out);
    ASSERT_EQ(rows.size(), 5 * layouts.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const nlohmann::json& row = rows[i];
      EXPECT_EQ(row.at("layout"), layouts[i / 5]);
      EXPECT_EQ(row.at("rival"), "voxdag_cpu");
      EXPECT_EQ(row.at("rival_agreement"), 1);
      EXPECT_EQ(row.at("device"), "cuda");
      EXPECT_EQ(row.at("device_name"), "the host");
      EXPECT_GT(row.at("mrays_per_s"), 0);
    }
  }
}

TEST_F(DeviceCommands, BenchEsvoMeasuresItAndFindsTheHitsOfTheCpu) {
  const std::vector<std::string> words = {"bench",
                                          "esvo",
                                          "Sponge=" + path("sponge.ply"),
                                          "-r",
                                          "16,32",
                                          "--size",
                                          "40x32",
                                          "--repeat",
                                          "1",
                                          "--views",
                                          "1",
                                          "-o",
                                          path("esvo.json")};
  const ProcessResult result = run_on("cuda", words);
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("per second, octrees on the host"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("per second of the CPU, with the same rays"), std::string::npos);
  const nlohmann::json rows = nlohmann::json::parse(read_text(path("esvo.json"))).at("rays");
  ASSERT_EQ(rows.size(), 1u);
  for (const nlohmann::json& row : rows) {
    EXPECT_EQ(row.at("device"), "cuda");
    EXPECT_EQ(row.at("device_name"), "the host");
    EXPECT_TRUE(row.at("triangles").at("agreement_with_cpu").is_null());
    std::vector<std::string> forms = {"cubes", "contours", "contours_beams"};
    if (!row.at("coarse_resolution").is_null())
      forms.insert(forms.end(), {"coarse_contours", "coarse_contours_beams"});
    for (const std::string& form : forms) {
      EXPECT_GT(row.at(form).at("mrays_per_s"), 0) << form;
      EXPECT_GT(row.at(form).at("cpu_mrays_per_s"), 0) << form;
      EXPECT_EQ(row.at(form).at("agreement_with_cpu"), 1) << form;
    }
  }
  const ProcessResult cpu = run_on("cpu", words);
  ASSERT_EQ(cpu.status, 0) << cpu.err;
  const nlohmann::json on_cpu = nlohmann::json::parse(read_text(path("esvo.json"))).at("rays");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(on_cpu[i].at("device"), "cpu");
    EXPECT_TRUE(on_cpu[i].at("cubes").at("cpu_mrays_per_s").is_null());
    EXPECT_EQ(on_cpu[i].at("ray_count"), rows[i].at("ray_count"));
    for (const char* form : {"cubes", "contours", "contours_beams"})
      EXPECT_EQ(on_cpu[i].at(form).at("agreement_with_triangles"),
                rows[i].at(form).at("agreement_with_triangles"))
          << form;
  }
}

TEST_F(DeviceCommands, BenchEsvoKeepsTheBuildsIfTheDeviceIsMissing) {
  const ProcessResult result =
      run_on("cuda:1", {"bench", "esvo", "Sponge=" + path("sponge.ply"), "-r", "16", "--size",
                        "40x32", "-o", path("builds.json")});
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.err,
            "voxdag: --device cuda: no CUDA device 1: the driver lists 1, numbered from 0\n");
  const nlohmann::json json = nlohmann::json::parse(read_text(path("builds.json")));
  EXPECT_EQ(json.at("builds").size(), 2u);
  EXPECT_TRUE(json.at("rays").empty());
}

TEST_F(DeviceCommands, BenchPapersMeasuresBothChaptersOnIt) {
  const auto report = [&](const char* device, const char* scenes) {
    const ProcessResult result =
        run_on(device, {"bench", "papers", "--quick", "--only", scenes, "--table1=16",
                        "--table2=16", "--esvo-tables=16", "--figure1=32", "--pictures=16",
                        "--esvo-pictures=16", "--flight-esvo=16", "--flight-triangles=32",
                        "--frames=1", "--size=24x16", "--cell-seconds=600", "-o", path("report")});
    EXPECT_EQ(result.status, 0) << result.err;
    const std::string text = read_text(path("report/report.md"));
    EXPECT_EQ(text.find("differ from the CPU's"), std::string::npos) << text;
    EXPECT_EQ(text.find("the host casts the rays at voxels") == std::string::npos,
              device == std::string("cpu"));
    return std::pair{result.out, nlohmann::json::parse(read_text(path("report/report.json")))};
  };
  const auto rays_at_esvos = [](const nlohmann::json& json) {
    return json.at("esvo").at("scenes").at(0).at("rays").at(0).at("result").at("rays").at(0);
  };
  const auto [ignored, cuda] = report("cuda", "SanMiguel,Sibenik");
  EXPECT_EQ(cuda.at("device"), "cuda");
  EXPECT_EQ(cuda.at("device_name"), "the host");
  EXPECT_EQ(rays_at_esvos(cuda).at("device"), "cuda");
  const nlohmann::json& svdag = cuda.at("svdag");
  const std::string picture = svdag.at("figure1").at("picture");
  EXPECT_NE(picture.find("--device cuda"), std::string::npos) << picture;
  for (const char* run : {"with_esvo", "with_triangles", "with_voxels", "with_cones"})
    for (const nlohmann::json& row : svdag.at("flight").at(run).at("rows"))
      EXPECT_EQ(row.at("device"), "cuda") << run;
  for (const nlohmann::json& row : svdag.at("flight").at("with_lamps").at("rows"))
    EXPECT_EQ(row.at("device"), row.at("rays") == "soft_lamp" ? "cpu" : "cuda");

  const auto [again, same] = report("cuda", "SanMiguel,Sibenik");
  EXPECT_NE(again.find(": 0 measured, "), std::string::npos) << again;
  const auto [other, cpu] = report("cpu", "Sibenik");
  EXPECT_EQ(cpu.at("device"), "cpu");
  EXPECT_EQ(rays_at_esvos(cpu).at("device"), "cpu");
  EXPECT_EQ(cpu.at("esvo").at("scenes").at(0).at("builds"),
            cuda.at("esvo").at("scenes").at(0).at("builds"))
      << "builds are kept";
}

TEST_F(DeviceCommands, AMissingDeviceIsRefused) {
  expect_failure(run_on("cuda:1", {"bench", "papers", "--quick", "-q", "-o", path("no_report")}), 1,
                 "--device cuda: no CUDA device 1: the driver lists 1, numbered from 0");
  expect_failure(run_on("cuda:1", {"render", path("in.vdag"), "-o", path("none.png")}), 1,
                 "no CUDA device 1: the driver lists 1, numbered from 0");
  EXPECT_FALSE(exists("none.png"));
  expect_failure(
      run_on("cuda:1", {"render", path("in.esvo"), "-o", path("none.png"), "--memory", "1G"}), 1,
      "--device cuda: no CUDA device 1: the driver lists 1, numbered from 0");
  expect_failure(
      run_on("cuda", {"render", path("in.esvo"), "-o", path("none.png"), "--memory", "1K"}), 1,
      "the memory limit is too small: a block and its ancestors need ");
  EXPECT_FALSE(exists("none.png"));
}

}  // namespace
}  // namespace voxdag::cli
