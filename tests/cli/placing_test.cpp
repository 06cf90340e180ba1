// Where inputs and grids lie, several inputs in one grid, and what solids are made of.
#include <gtest/gtest.h>

#include "json.hpp"
#include "process.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag::cli {
namespace {

using Json = nlohmann::json;

std::string box(Vec3d lo, Vec3d hi) {
  std::string text;
  for (int corner = 0; corner < 8; ++corner)
    text += "v " + std::to_string(corner & 1 ? hi.x : lo.x) + " " +
            std::to_string(corner & 2 ? hi.y : lo.y) + " " +
            std::to_string(corner & 4 ? hi.z : lo.z) + "\n";
  return text +
         "f -8 -6 -5 -7\nf -4 -3 -1 -2\nf -8 -7 -3 -4\nf -6 -2 -1 -5\nf -8 -4 -2 -6\nf -7 -5 -1 "
         "-3\n";
}

class Placing : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return dir_ / name; }
  static std::string run(const std::vector<std::string>& arguments) {
    const ProcessResult result = run_voxdag(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    return result.out;
  }
  /// Builds FILE.vdag in the folder and returns what `voxdag info` tells.
  Json build(const std::string& output, std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"build", "-o", path(output)});
    run(arguments);
    return Json::parse(run({"info", path(output), "--json"}));
  }
  TempDir dir_;
};

TEST_F(Placing, ASolidBoxOfAnyResolutionIsFull) {
  write_text(path("b.obj"), box({4, 4, 4}, {12, 12, 12}));
  for (const int n : {1, 3, 10, 31}) {
    const Json info = build("b.vdag", {path("b.obj"), "-r", std::to_string(n), "--solid"});
    EXPECT_EQ(info.at("voxels"), n * n * n);
    EXPECT_EQ(info.at("build").at("resolution"), std::to_string(n));
    EXPECT_EQ(run_voxdag({"verify", path("b.vdag"), "--mesh", path("b.obj")}).status, 0);
  }
  EXPECT_EQ(build("b.vdag", {path("b.obj"), "--voxel-size", "1", "--snap", "--solid"}).at("voxels"),
            512);
}

TEST_F(Placing, SnappedBuildsCombineAndOthersAreRefused) {
  write_text(path("a.obj"), box({0.3, 0.3, 0.3}, {3.7, 3.7, 3.7}));
  write_text(path("b.obj"), box({2.9, 2.9, 2.9}, {7.6, 7.6, 7.6}));
  write_text(path("a.xyz"), "10.3 20.7 5.2\n");
  write_text(path("b.xyz"), "11.9 20.1 5.9\n");
  for (const std::string name : {"a", "b"}) {
    build(name + ".vdag", {path(name + ".obj"), "--voxel-size", "0.1", "--snap"});
    run({"import", path(name + ".xyz"), "--voxel-size", "0.1", "--snap", "-o",
         path(name + "p.vdag")});
  }
  run({"combine", path("a.vdag"), path("b.vdag"), "--union", "-o", path("c.vdag")});
  run({"combine", path("ap.vdag"), path("bp.vdag"), "--union", "-o", path("c.vdag")});
  EXPECT_EQ(Json::parse(run({"info", path("c.vdag"), "--json"})).at("voxels"), 2);
  build("a.vdag", {path("a.obj"), "--voxel-size", "1"});
  build("b.vdag", {path("b.obj"), "--voxel-size", "1"});
  expect_failure(
      run_voxdag({"combine", path("a.vdag"), path("b.vdag"), "--union", "-o", path("c.vdag")}), 1,
      "the grids do not align");
}

TEST_F(Placing, MovedInputsAreCheckedAgainstTheirMeshAndSayHow) {
  write_text(path("b.obj"), box({0, 0, 0}, {1, 2, 4}));
  const std::vector<std::string> moves = {"--unit", "in:mm",    "--up", "z",           "--scale",
                                          "2",      "--rotate", "z:90", "--translate", "1,2,3"};
  std::vector<std::string> arguments = {path("b.obj"), "-r", "64"};
  arguments.insert(arguments.end(), moves.begin(), moves.end());
  const Json info = build("b.vdag", arguments);
  // Along z to -y, then to x.
  const Json origin = info.at("transform").at("origin");
  EXPECT_FLOAT_EQ(origin[0].get<float>(), 1);
  EXPECT_FLOAT_EQ(origin[1].get<float>(), 2);
  EXPECT_FLOAT_EQ(origin[2].get<float>(), 3);
  EXPECT_EQ(info.at("build").at("up"), "z");
  EXPECT_EQ(info.at("build").at("unit"), "mm");
  EXPECT_EQ(run_voxdag({"verify", path("b.vdag"), "--mesh", path("b.obj")}).status, 0);
  arguments.insert(arguments.begin(), {"build", "-o", path("parts.vdag"), "--parts", "3"});
  EXPECT_NE(run(arguments).find("moved"), std::string::npos);
  EXPECT_EQ(read_text(path("parts.vdag")), read_text(path("b.vdag")));
}

TEST_F(Placing, SeveralFilesShareAGridAndHaveIds) {
  std::filesystem::create_directory(path("parts"));
  write_text(path("parts/a.obj"),
             "o lid\n" + box({0, 0, 0}, {1, 1, 1}) + "o pot\n" + box({2, 0, 0}, {3, 1, 1}));
  write_text(path("parts/b.obj"), box({0, 0, 5}, {8, 1, 6}));
  const auto names = [](const Json& info) {
    return info.at("attributes").at("material").at("names");
  };
  const Json files = build("f.vdag", {path("parts"), "-r", "40", "--ids", "file"});
  EXPECT_EQ(names(files), Json::array({"a.obj", "b.obj"}));
  EXPECT_EQ(files.at("source").at("name"), "a.obj, b.obj");
  EXPECT_EQ(files.at("source").at("triangles"), 36);
  const Json objects = build("o.vdag", {path("parts/*.obj"), "-r", "40", "--ids", "object"});
  EXPECT_EQ(names(objects), Json::array({"a.obj/lid", "a.obj/pot", "b.obj"}));
  EXPECT_EQ(objects.at("build").at("ids"), "object");
  EXPECT_EQ(run_voxdag({"verify", path("o.vdag"), "--mesh", path("parts/a.obj"), "--mesh",
                        path("parts/b.obj")})
                .status,
            0);
  // Without materials, --material-ids numbers the objects of one file.
  EXPECT_EQ(names(build("m.vdag", {path("parts/a.obj"), "-r", "40", "--material-ids"})),
            Json::array({"lid", "pot"}));
  EXPECT_NE(run({"info", path("m.vdag")}).find("2 objects: lid, pot"), std::string::npos);
  expect_failure(run_voxdag({"build", path("parts/b.obj"), "-r", "40", "--material-ids", "-o",
                             path("x.vdag")}),
                 1, "has no materials");
  expect_failure(run_voxdag({"build", path("parts/a.obj"), path("parts/b.obj"), "-r", "40", "-o",
                             path("parts/b.obj")}),
                 2, "would overwrite");
}

TEST_F(Placing, FilesWithOneNameAreNamedByTheirPaths) {
  for (const std::string folder : {"a", "b"}) {
    std::filesystem::create_directory(path(folder));
    write_text(path(folder + "/pot.obj"), box({0, 0, 0}, {1, 1, 1}));
  }
  write_text(path("lid.obj"), box({0, 0, 1}, {1, 1, 2}));
  const Json info = build("p.vdag", {path("a/pot.obj"), path("b/pot.obj"), path("lid.obj"), "-r",
                                     "8", "--ids", "file"});
  EXPECT_EQ(info.at("attributes").at("material").at("names"),
            Json::array({path("a/pot.obj"), path("b/pot.obj"), "lid.obj"}));
}

TEST_F(Placing, InputsThatTellTooLittleAreRefused) {
  std::filesystem::create_directory(path("none"));
  expect_failure(run_voxdag({"build", path("none"), "-r", "8", "-o", path("n.vdag")}), 2,
                 "the folder " + path("none") + " has no file that ends in .obj, .ply,");
}

TEST_F(Placing, SeveralCloudsAreOne) {
  std::filesystem::create_directory(path("tiles"));
  write_text(path("tiles/a.xyz"), "0 0 0\n1 0 0\n");
  write_text(path("tiles/b.xyz"), "7 1 0\n1 0 0\n");
  write_text(path("tiles/._b.xyz"), "the note that macOS writes beside b.xyz");
  const Json result = Json::parse(
      run({"import", path("tiles"), "--voxel-size", "1", "-o", path("t.vdag"), "--json"}));
  EXPECT_EQ(result.at("read"), 4);
  EXPECT_EQ(result.at("voxels"), 3);
}

TEST_F(Placing, TheInsideHasTheColourOfTheNearestSurface) {
  write_text(path("b.mtl"), "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
  std::string text = box({0, 0, 0}, {8, 8, 8});
  text.insert(text.find("f "), "usemtl red\n");
  text.insert(text.find("f -4"), "usemtl blue\n");
  text.insert(text.find("f -8 -7"), "usemtl red\n");
  write_text(path("b.obj"), "mtllib b.mtl\n" + text);
  const auto colors = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(),
                     {path("b.obj"), "-r", "16", "--solid", "--color", "--color-bound", "0"});
    EXPECT_EQ(build("b.vdag", arguments).at("voxels"), 4096);
    const ProcessResult check = run_voxdag({"verify", path("b.vdag"), "--mesh", path("b.obj")});
    EXPECT_EQ(check.status, 0) << check.err;
    EXPECT_NE(check.out.find("colours"), std::string::npos) << check.out;
    run({"export", path("b.vdag"), "-o", path("b.ply")});
    const std::string ply = read_text(path("b.ply"));
    return ply.substr(ply.find("end_header"));
  };
  EXPECT_EQ(colors({}).size(), colors({"--inside-color", "1,2,3"}).size());
  EXPECT_NE(colors({}), colors({"--inside-color", "1,2,3"}));
  write_text(path("b.mtl"), "newmtl red\nKd 1 1 0\nnewmtl blue\nKd 0 0 1\n");
  EXPECT_EQ(run_voxdag({"verify", path("b.vdag"), "--mesh", path("b.obj")}).status, 1);
}

}  // namespace
}  // namespace voxdag::cli
