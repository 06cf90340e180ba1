/// Tests `voxdag import`.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "colored_waves.hpp"
#include "sponge.hpp"

namespace voxdag::cli {
namespace {

class ImportCommand : public Sponge {};

TEST_F(ImportCommand, ExportedVoxelsComeBack) {
  ASSERT_EQ(run_voxdag({"export", path("in.vdag"), "-o", path("voxels.npy"), "-q"}).status, 0);
  const ProcessResult info = run_voxdag({"info", path("in.vdag"), "--json"});
  const nlohmann::json original = nlohmann::json::parse(info.out);
  const std::string resolution = original.at("resolution").dump();
  const ProcessResult result = run_voxdag(
      {"import", path("voxels.npy"), "-r", resolution, "-o", path("back.vdag"), "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const nlohmann::json json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json.at("voxels"), original.at("voxels"));
  EXPECT_EQ(json.at("dag_nodes"), original.at("dag_nodes"));
  EXPECT_EQ(run_voxdag({"verify", path("back.vdag")}).status, 0);
  // The same bytes with any memory and any number of threads, and from the compact form.
  ASSERT_EQ(run_voxdag({"import", path("voxels.npy"), "-r", resolution, "-o", path("again.vdag"),
                        "--memory", "2G", "--threads", "1"})
                .status,
            0);
  EXPECT_EQ(read_text(path("again.vdag")), read_text(path("back.vdag")));
  ASSERT_EQ(run_voxdag({"import", path("voxels.npy"), "-r", resolution, "-o", path("small.vdag"),
                        "--compact"})
                .status,
            0);
  ASSERT_EQ(run_voxdag({"convert", path("small.vdag"), "--plain", "-o", path("again.vdag")}).status,
            0);
  EXPECT_EQ(read_text(path("again.vdag")), read_text(path("back.vdag")));
}

TEST_F(ImportCommand, PointsNeedAGrid) {
  write_text(path("p.xyz"), "0 0 0\n1 2 3\n4 4 4\n");
  const ProcessResult result =
      run_voxdag({"import", path("p.xyz"), "-r", "16", "-o", path("p.vdag")});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("3 read, 3 voxels of 16³"), std::string::npos) << result.out;
  const ProcessResult inside = run_voxdag({"import", path("p.xyz"), "--voxel-size", "0.5",
                                           "--bounds", "0,0,0,2,3,4", "-o", path("p.vdag")});
  ASSERT_EQ(inside.status, 0) << inside.err;
  EXPECT_NE(inside.out.find("3 read, 1 of them outside, 2 voxels"), std::string::npos)
      << inside.out;
  const auto refused = [](std::vector<std::string> options, int status, const std::string& text) {
    options.insert(options.end(), {"-o", path("none.vdag")});
    options.insert(options.begin(), "import");
    expect_failure(run_voxdag(options), status, text);
    EXPECT_EQ(files_like("none"), 0);
  };
  refused({path("p.xyz"), "-r", "16", "--voxel-size", "1"}, 2, "--voxel-size");
  refused({path("in.vdag"), "-r", "16"}, 1, "is none of .npy");
  refused({path("nothing.xyz"), "-r", "16"}, 1, "nothing.xyz");
  write_text(path("p.xyz"), "0 0 0\n1 two 3\n");
  refused({path("p.xyz"), "-r", "16"}, 1, path("p.xyz") + ": line 2: number 2");
  write_text(path("p.xyz"), "0 0 0\n1 2 3\n");
  write_text(path("b.binvox"), "#binvox 1\ndim 4 4 4\ndata\n");
  refused({path("b.binvox"), "--bounds", "0,0,0,1,1,1"}, 1, "is for points");
  write_text(path("b.binvox"), "#binvox 1\ndim 4 4 4\nscale 2\ndata\n");
  refused({path("b.binvox"), "--voxel-size", "1"}, 1, "says itself where its voxels lie");
  refused({path("b.binvox"), "--origin", "1,2,3"}, 1, "says itself where its voxels lie");
  refused({path("p.xyz"), "-r", "16", "--origin", "1,2,3", "--bounds", "0,0,0,1,1,1"}, 1,
          "--origin goes with -r or --voxel-size");
  refused({path("b.binvox")}, 1, "ends after 0 of 64 values");
  std::filesystem::create_directory(path("slices"));
  write_text(path("slices/1.png"), "no picture");
  refused({path("slices")}, 1, "voxdag: " + path("slices/1.png") + ": ");
}

TEST_F(ImportCommand, AnImportWithoutVoxelsIsAWarning) {
  write_text(path("p.xyz"), "5 5 5\n");
  const ProcessResult outside = run_voxdag(
      {"import", path("p.xyz"), "-r", "4", "--bounds", "0,0,0,1,1,1", "-o", path("p.vdag")});
  ASSERT_EQ(outside.status, 0) << outside.err;
  EXPECT_NE(outside.err.find("no voxels: all points lie outside of the grid"), std::string::npos)
      << outside.err;
  write_text(path("v.nrrd"),
             "NRRD0004\ntype: int\ndimension: 3\nsizes: 1 1 1\nencoding: ascii\n\n0\n");
  const ProcessResult none = run_voxdag({"import", path("v.nrrd"), "-o", path("p.vdag")});
  ASSERT_EQ(none.status, 0) << none.err;
  EXPECT_NE(none.err.find("no voxels: v.nrrd sets none"), std::string::npos) << none.err;
}

TEST_F(ImportCommand, ColoredPointsComeBackAsTheyWere) {
  write_text(path("waves.obj"), colored_waves());
  const auto run = [](const std::vector<std::string>& arguments) {
    const ProcessResult result = run_voxdag(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    return result.out;
  };
  const auto info = [&](const std::string& name) {
    return nlohmann::json::parse(run({"info", path(name), "--json"}));
  };
  run({"build", path("waves.obj"), "-r", "64", "--color", "--color-bound", "0", "-o",
       path("waves.vdag")});
  run({"export", path("waves.vdag"), "-o", path("waves.ply"), "-q"});
  // The points are the centres of the voxels.
  const nlohmann::json transform = info("waves.vdag").at("transform");
  const double size = transform.at("voxel_size");
  std::string bounds;
  for (int corner = 0; corner < 2; ++corner)
    for (const double origin : transform.at("origin"))
      bounds += (bounds.empty() ? "" : ",") + std::to_string(origin + corner * 64 * size);
  run({"import", path("waves.ply"), "-r", "64", "--bounds", bounds, "--color-bound", "0", "-o",
       path("back.vdag")});
  EXPECT_EQ(nlohmann::json::parse(run({"diff", path("waves.vdag"), path("back.vdag"), "--json"}))
                .at("differing"),
            0);
  const nlohmann::json color = info("back.vdag").at("attributes").at("color");
  EXPECT_EQ(color.at("resolution"), 64);
  EXPECT_TRUE(color.at("psnr_db").is_null());
  EXPECT_EQ(run_voxdag({"verify", path("back.vdag")}).status, 0);
  // Voxel by voxel, the colours are those that were exported.
  run({"export", path("back.vdag"), "-o", path("back.ply"), "-q"});
  const std::string before = read_text(path("waves.ply")), after = read_text(path("back.ply"));
  // Rows are three floats and three bytes.
  const auto colors_of = [](const std::string& ply) {
    constexpr std::size_t kRow = 15;
    const std::string body = ply.substr(ply.find("end_header\n") + 11);
    EXPECT_EQ(body.size() % kRow, 0u);
    std::string colors;
    for (std::size_t row = 0; row + kRow <= body.size(); row += kRow)
      colors += body.substr(row + kRow - 3, 3);
    return colors;
  };
  EXPECT_TRUE(colors_of(before) == colors_of(after));
  run({"import", path("waves.ply"), "-r", "64", "--bounds", bounds, "--no-color", "-o",
       path("grey.vdag")});
  EXPECT_FALSE(info("grey.vdag").contains("attributes"));
  expect_failure(run_voxdag({"import", path("waves.ply"), "-r", "64", "--threshold", "1", "-o",
                             path("none.vdag")}),
                 1, "no values to compare with a threshold");
}

TEST_F(ImportCommand, VolumesHaveAThreshold) {
  // x runs fastest: the values are 0 to 63.
  std::string values;
  for (int i = 0; i < 64; ++i) values += std::to_string(i) + " ";
  write_text(path("v.nrrd"),
             "NRRD0004\ntype: int\ndimension: 3\nsizes: 4 4 4\nspacings: 1 2 1\nencoding: "
             "ascii\n\n" +
                 values + "\n");
  const ProcessResult all = run_voxdag({"import", path("v.nrrd"), "-o", path("v.vdag")});
  ASSERT_EQ(all.status, 0) << all.err;
  EXPECT_NE(all.out.find("126 voxels of 8³"), std::string::npos) << all.out;
  EXPECT_NE(all.err.find("cubes"), std::string::npos) << all.err;
  const ProcessResult some =
      run_voxdag({"import", path("v.nrrd"), "--threshold", "60", "-o", path("v.vdag"), "-q"});
  EXPECT_EQ(some.status, 0) << some.err;
  const ProcessResult count = run_voxdag({"query", path("v.vdag"), "--count", "--json"});
  EXPECT_NE(count.out.find("8"), std::string::npos) << count.out;
  expect_failure(
      run_voxdag({"import", path("v.nrrd"), "--threshold", "many", "-o", path("n.vdag")}), 2,
      "--threshold");
}

}  // namespace
}  // namespace voxdag::cli
