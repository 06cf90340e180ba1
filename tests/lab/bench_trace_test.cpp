#include <map>
#include <nlohmann/json.hpp>

#include "cli/sponge.hpp"

namespace voxdag::lab {
using namespace cli;
namespace {

using Json = nlohmann::json;

class BenchTrace : public Sponge {
 protected:
  static ProcessResult bench(std::vector<std::string> options) {
    const std::vector<std::string> start = {"bench",    "trace", "--size",  "40x32",
                                            "--repeat", "1",     "--views", "2"};
    options.insert(options.begin(), start.begin(), start.end());
    return run_voxdag(options);
  }
};

TEST_F(BenchTrace, JsonHasEveryKindOfRays) {
  const ProcessResult result = bench({path("in.vdag"), "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json json = Json::parse(result.out);
  ASSERT_EQ(json.size(), 5u);
  const char* const kinds[] = {"primary", "primary_beams", "shadow", "soft", "ao"};
  for (std::size_t i = 0; i < json.size(); ++i) {
    EXPECT_EQ(json[i].at("rays"), kinds[i]);
    EXPECT_EQ(json[i].at("scene"), "sponge.ply");
    EXPECT_EQ(json[i].at("resolution"), 32);
    EXPECT_EQ(json[i].at("device"), "cpu");
    EXPECT_TRUE(json[i].at("rival").is_null());
    for (const char* key : {"mrays_per_s", "cells_per_ray", "bytes_per_ray", "ray_count"})
      EXPECT_GT(json[i].at(key), 0) << kinds[i] << " " << key;
  }
  // Beams only shorten rays: shortened rays meet the cells that rays from the eye meet.
  EXPECT_EQ(json[0].at("ray_count"), json[1].at("ray_count"));
  EXPECT_EQ(json[0].at("hit_part"), json[1].at("hit_part"));
}

TEST_F(BenchTrace, EmbreeAndTinybvhMeetTheSameWithTheSameRays) {
  const ProcessResult result = bench({path("in.vdag"), "--mesh", path("sponge.ply"), "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json json = Json::parse(result.out);
  if (json.at(0).at("rival").is_null()) GTEST_SKIP() << "built without Embree";
  std::map<std::string, int> kinds;
  for (const Json& row : json) {
    ++kinds[row.at("rival")];
    EXPECT_GT(row.value("rival_at_embrees_place", 1.0), 0.99);
    EXPECT_GT(row.at("rival_mrays_per_s"), 0);
    // Voxels of a 32nd of the scene are not its triangles: outlines differ by a voxel.
    EXPECT_GT(row.at("rival_agreement"), 0.9) << row.at("rays");
  }
  std::map<std::string, int> expected{{"embree_single", 5}, {"embree_packet16", 5}};
  if (kinds.size() > 2) expected.insert({{"tinybvh", 5}, {"tinybvh_hq", 5}});
  EXPECT_EQ(kinds, expected);
}

TEST_F(BenchTrace, AnEsvoCastsTheSameRaysAlongAPath) {
  write_text(path("path.json"),
             R"({"keys": [{"time": 0, "eye": [-2, 0.4, 0.4], "target": [1, 0.5, 0.5]},)"
             R"({"time": 2, "eye": [-1, 1.5, 0.4], "target": [1, 0.5, 0.5]}]})");
  ASSERT_EQ(run_voxdag(
                {"build", path("sponge.ply"), "-r", "32", "--no-contours", "-o", path("same.esvo")})
                .status,
            0);
  const ProcessResult result =
      run_voxdag({"bench", "trace", path("in.vdag"), "--esvo", path("same.esvo"), "--path",
                  path("path.json"), "--frames", "3", "--size", "40x32", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json json = Json::parse(result.out);
  ASSERT_EQ(json.size(), 5u);
  for (const Json& row : json) {
    EXPECT_EQ(row.at("rival"), "esvo");
    EXPECT_EQ(row.at("view_mrays_per_s").size(), 3u);
    EXPECT_EQ(row.at("rival_view_mrays_per_s").size(), 3u);
    EXPECT_EQ(row.at("rival_agreement"), 1) << row.at("rays");  // cubes are the DAG's voxels
  }
}

TEST_F(BenchTrace, SoftShadowsAreMeasuredForEverySizeOfTheLamp) {
  const ProcessResult result = bench({path("in.vdag"), "--light-sizes", "0.1,0.5", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json json = Json::parse(result.out);
  ASSERT_EQ(json.size(), 7u);
  for (std::size_t i = 0; i < 2; ++i) {
    const Json& row = json[5 + i];
    EXPECT_EQ(row.at("rays"), "soft_lamp");
    EXPECT_EQ(row.at("light_size"), i == 0 ? 0.1 : 0.5);
    EXPECT_EQ(row.at("rival"), "without_beams");
    for (const char* key : {"ray_count", "mrays_per_s", "rival_mrays_per_s", "ratio"})
      EXPECT_GT(row.at(key), 0) << key;
  }
}

TEST_F(BenchTrace, AnEsvoOnAnotherGridIsAnError) {
  ASSERT_EQ(run_voxdag({"build", path("sponge.ply"), "-r", "64", "-o", path("other.esvo")}).status,
            0);
  expect_failure(bench({path("in.vdag"), "--esvo", path("other.esvo"), "-q"}), 1,
                 "is not on the grid of the DAG");
  expect_failure(bench({path("in.vdag"), "--esvo", path("in.vdag"), "-q"}), 1, "is not an ESVO");
}

TEST_F(BenchTrace, AllLayoutsMeetTheSame) {
  const ProcessResult result =
      bench({path("in.vdag"), "--layout", "paper,paper_scalar,top", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json json = Json::parse(result.out);
  ASSERT_EQ(json.size(), 15u);
  for (std::size_t i = 0; i < 15; ++i) {
    EXPECT_EQ(json[i].at("layout"), i < 5 ? "paper" : i < 10 ? "paper_scalar" : "top");
    EXPECT_EQ(json[i].at("hit_part"), json[i % 5].at("hit_part"));
    EXPECT_LE(json[i].at("cells_per_ray"), json[i % 5].at("cells_per_ray"));
  }
}

TEST_F(BenchTrace, FinerBeamsShortenRays) {
  const auto row = [](const char* pixels) {
    const ProcessResult result = bench({path("in.vdag"), "--beam-pixels", pixels, "--json"});
    return result.status == 0 ? Json::parse(result.out).at(1) : Json();
  };
  const Json coarse = row("8"), fine = row("4");
  EXPECT_EQ(fine.at("rays"), "primary_beams");
  EXPECT_EQ(fine.at("beam_pixels"), 4);
  EXPECT_EQ(fine.at("hit_part"), coarse.at("hit_part"));
  EXPECT_LT(fine.at("cells_per_ray"), coarse.at("cells_per_ray"));
  expect_failure(bench({path("in.vdag"), "--beam-pixels", "5"}), 2, "is neither 4 nor 8");
}

TEST_F(BenchTrace, OcclusionMayEndAtCellsOfASolidAngle) {
  const auto rows = [](const char* cone) {
    const ProcessResult result = bench({path("in.vdag"), "--ao-cone", cone, "--json"});
    return result.status == 0 ? Json::parse(result.out) : Json();
  };
  const Json exact = rows("0"), ended = rows("0.5");
  ASSERT_EQ(exact.size(), 5u);
  ASSERT_EQ(ended.size(), 5u);
  EXPECT_EQ(ended[3].at("cells_per_ray"), exact[3].at("cells_per_ray"));
  EXPECT_LT(ended[4].at("cells_per_ray"), exact[4].at("cells_per_ray"));
  EXPECT_EQ(exact[4].at("ao_cone"), 0);
  EXPECT_EQ(ended[4].at("ao_cone"), 0.5);
  EXPECT_EQ(ended[4].at("lod_pixels"), 1);
  EXPECT_EQ(ended[4].at("size"), Json({40, 32}));
  EXPECT_GT(ended[4].at("hit_part"), exact[4].at("hit_part"));
}

TEST_F(BenchTrace, WritesTableJsonAndPlot) {
  const ProcessResult result =
      bench({path("in.vdag"), "-o", path("rays.json"), "--plot", path("rays.svg")});
  if (lacks_matplotlib(result)) GTEST_SKIP() << "matplotlib is not installed";
  ASSERT_EQ(result.status, 0) << result.err;
  for (const char* text : {"sponge.ply 32³", "Mrays/s", "cells", "primary_beams", "ao"})
    EXPECT_NE(result.out.find(text), std::string::npos) << text;
  EXPECT_EQ(Json::parse(read_text(path("rays.json"))).size(), 5u);
  EXPECT_NE(read_text(path("rays.svg")).find("<svg"), std::string::npos);
}

TEST_F(BenchTrace, RefusesWhatItCannotMeasure) {
  expect_failure(bench({path("sponge.ply")}), 1, "sponge.ply");
  expect_failure(bench({path("in.vdag"), "--layout", "thin"}), 2, "--layout");
  expect_failure(bench({path("in.vdag"), "--openvdb", path("absent")}), 1, "absent");
  expect_failure(bench({path("in.vdag"), "--nanovdb", path("absent")}), 1, "absent");
}

/// Writes a program that obeys lab/rivals/trace_program.hpp and hits nothing.
void write_rival_that_hits_nothing(const std::string& file) {
  write_text(file, R"(#!/bin/sh
[ -f "$1" ] && [ "$2" -ge 1 ] && [ "$3" -eq 1 ] || exit 1
shift 3
for rays; do
  count=$(head -n 1 "$rays" | LC_ALL=C sed 's/.*(\([0-9]*\), 8).*/\1/')
  head -c "$count" /dev/zero >"$rays.hits"
  seconds="$seconds${seconds:+, }0.5"
done
echo "{\"seconds\": [$seconds], \"bytes\": 7}"
)");
  std::filesystem::permissions(file, std::filesystem::perms::owner_all);
}

TEST_F(BenchTrace, RivalsMayBeProgramsNamedByRelativePaths) {
  write_rival_that_hits_nothing(path("rival"));
  const std::string relative = std::filesystem::relative(path("rival")).string();
  for (const auto& [option, name] :
       {std::pair{"--openvdb", "openvdb"}, std::pair{"--nanovdb", "nanovdb_cuda"}}) {
    const ProcessResult result = bench({path("in.vdag"), option, relative, "--lod", "0", "--json"});
    ASSERT_EQ(result.status, 0) << result.err;
    std::size_t rows = 0;
    for (const Json& row : Json::parse(result.out)) {
      if (row.at("rival") != name) continue;
      ++rows;
      EXPECT_EQ(row.at("rival_bytes"), 7);
      EXPECT_NEAR(row.at("rival_agreement").get<double>(), 1 - row.at("hit_part").get<double>(),
                  1e-9);
      EXPECT_GT(row.at("rival_mrays_per_s"), 0);
    }
    EXPECT_EQ(rows, 5u) << name;
  }
}

TEST_F(BenchTrace, TakesEsvosInBothForms) {
  ASSERT_EQ(run_voxdag({"build", path("sponge.ply"), "-r", "32", "-o", path("in.esvo")}).status, 0);
  const ProcessResult result = bench({path("in.esvo"), "--layout", "contours,cubes", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  std::set<std::string> layouts;
  for (const auto& row : nlohmann::json::parse(result.out)) {
    layouts.insert(row.at("layout"));
    EXPECT_GT(row.at("mrays_per_s"), 0);
    EXPECT_GT(row.at("bytes_per_ray"), 0);
  }
  EXPECT_EQ(layouts, (std::set<std::string>{"contours", "cubes"}));
  const ProcessResult other = bench({path("in.esvo"), "--layout", "top"});
  EXPECT_EQ(other.status, 1);
  EXPECT_NE(other.err.find("no layout \"top\" of an ESVO"), std::string::npos) << other.err;
}

}  // namespace
}  // namespace voxdag::lab
