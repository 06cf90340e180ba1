#include <gtest/gtest.h>

#include "json.hpp"
#include "process.hpp"
#include "support/temp_dir.hpp"

namespace voxdag::cli {
namespace {

/// A tetrahedron with a colour in each corner.
constexpr const char* kCornerColors =
    "v 1 2 3 1 0 0\nv 5 2 3 0 1 0\nv 1 4 3 0 0 1\nv 1 2 5 1 1 0\n"
    "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

class SceneInputs : public testing::Test {
 protected:
  SceneInputs() {
    write_text(mesh_, kCornerColors);
    write_text(points_, "0 0 0\n1 2 3\n3 1 2\n");
  }

  /// Runs a shell command in the folder, in which $VOXDAG is the program.
  ProcessResult shell(const std::string& command) const {
    return Process({"bash", "-c",
                    "cd '" + dir_.path().string() + "'; VOXDAG='" + voxdag_command({})[0] + "'; " +
                        command})
        .wait();
  }

  TempDir dir_;
  std::string mesh_ = dir_ / "mesh.obj", points_ = dir_ / "points.xyz", dag_ = dir_ / "a.vdag";
};

TEST_F(SceneInputs, AMeshIsShownAsTheDagThatBuildMakesOfIt) {
  ASSERT_EQ(run_voxdag({"build", mesh_, "-r", "64", "--color", "-o", dag_}).status, 0);
  for (const std::string& of : {mesh_, dag_}) {
    std::vector<std::string> r =
        of == mesh_ ? std::vector<std::string>{"-r", "64"} : std::vector<std::string>{};
    const auto run = [&](std::vector<std::string> arguments) {
      arguments.insert(arguments.end(), r.begin(), r.end());
      const ProcessResult result = run_voxdag(arguments);
      EXPECT_EQ(result.status, 0) << result.err;
      EXPECT_EQ(result.err.find("64³ voxels") != result.err.npos, of == mesh_) << result.err;
    };
    const std::string name = of == mesh_ ? "mesh" : "dag";
    run({"render", of, "--size", "64x48", "-o", dir_ / (name + ".png")});
    run({"export", of, "-o", dir_ / (name + ".ply")});
    run({"export", of, "-o", dir_ / (name + ".html")});
    run({"query", of, "--heights", "y", "-o", dir_ / (name + ".npy")});
  }
  for (const std::string ending : {".png", ".ply", ".html", ".npy"})
    EXPECT_TRUE(read_text(dir_ / ("mesh" + ending)) == read_text(dir_ / ("dag" + ending)))
        << ending;
}

TEST_F(SceneInputs, PointsAndVoxelsAreImported) {
  const ProcessResult points = run_voxdag({"query", points_, "--count"});
  EXPECT_EQ(points.out, points_ + ": 3 voxels\n");
  EXPECT_NE(points.err.find(points_ + ": built a DAG of 1024³ voxels (-r N"), points.err.npos);
  write_text(
      dir_ / "cloud.ply",
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
      "property float z\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 1 1\n");
  EXPECT_EQ(run_voxdag({"query", dir_ / "cloud.ply", "--count", "-r", "8"}).out,
            (dir_ / "cloud.ply").string() + ": 2 voxels\n");
  ASSERT_EQ(run_voxdag({"build", mesh_, "-r", "16", "-o", dir_ / "v.vox"}).status, 0);
  const ProcessResult voxels = run_voxdag({"query", dir_ / "v.vox", "--count"});
  EXPECT_NE(voxels.err.find("16³ voxels"), voxels.err.npos) << voxels.err;
}

TEST_F(SceneInputs, KeepWritesTheDagAndNothingElseIsLeft) {
  const long before = dir_.count();
  EXPECT_EQ(run_voxdag({"query", mesh_, "--count", "-r", "32"}).status, 0);
  EXPECT_EQ(dir_.count(), before);
  EXPECT_EQ(run_voxdag({"query", mesh_, "--count", "-r", "32", "--keep", dag_}).status, 0);
  EXPECT_EQ(run_voxdag({"verify", dag_}).status, 0);
  EXPECT_EQ(dir_.count(), before + 1);
  expect_failure(run_voxdag({"query", dag_, "--count", "-r", "32"}), 2, "on a .vdag");
  expect_failure(run_voxdag({"query", dag_, "--count", "--keep", dir_ / "b.vdag"}), 2, "--keep");
  expect_failure(run_voxdag({"query", mesh_, "--count", "--keep", dir_ / "b.glb"}), 2, ".vdag");
}

TEST_F(SceneInputs, ErrorsNameTheFileThatTheUserGave) {
  write_text(dir_ / "bad.obj", "v 0 0 zero\n");
  expect_failure(run_voxdag({"query", dir_ / "bad.obj", "--count"}), 1, "bad.obj");
  const ProcessResult esvo = run_voxdag({"query", mesh_, "--count", "--memory", "1K"});
  EXPECT_EQ(esvo.err.find("/proc/"), esvo.err.npos) << esvo.err;
}

TEST_F(SceneInputs, QuietCommandsDoNotSayWhatTheyBuild) {
  EXPECT_EQ(run_voxdag({"query", mesh_, "--count", "-r", "32", "--quiet"}).err, "");
}

TEST_F(SceneInputs, BuildAndImportHaveADefaultResolutionAndName) {
  EXPECT_EQ(shell("$VOXDAG build mesh.obj").out.substr(0, 11), "mesh.vdag: ");
  EXPECT_EQ(shell("$VOXDAG import points.xyz").out.substr(0, 13), "points.vdag: ");
  for (const std::string file : {"mesh.vdag", "points.vdag"}) {
    const auto info = nlohmann::json::parse(run_voxdag({"info", dir_ / file, "--json"}).out);
    EXPECT_EQ(info["resolution"], 1024);
  }
  EXPECT_EQ(shell("$VOXDAG build mesh.obj -r 16 --as esvo").out.substr(0, 11), "mesh.esvo: ");
  EXPECT_EQ(shell("$VOXDAG build mesh.obj -r 16").status, 0) << "an older DAG is replaced";
}

TEST_F(SceneInputs, RenderHasADefaultNameThatReplacesNothing) {
  ASSERT_EQ(run_voxdag({"build", mesh_, "-r", "32", "-o", dag_}).status, 0);
  const std::string small = " --size 32x18 --ao 0";
  EXPECT_EQ(shell("$VOXDAG render a.vdag" + small).out.substr(0, 7), "a.png: ");
  const std::string picture = read_text(dir_ / "a.png");
  EXPECT_EQ(picture.substr(1, 3), "PNG");
  expect_failure(shell("$VOXDAG render a.vdag" + small), 2, "--output: is required: a.png exists");
  EXPECT_EQ(shell("$VOXDAG render mesh.obj -r 32" + small).out.substr(0, 10), "mesh.png: ");
  expect_failure(shell("$VOXDAG render a.vdag --path none.json"), 2, "--output: is required");
  // Standard output has the same bytes, and the summary calls it so.
  const ProcessResult piped = shell("$VOXDAG render a.vdag -o -" + small);
  EXPECT_TRUE(piped.out == picture);
  EXPECT_NE(piped.err.find("standard output: 32 x 18"), piped.err.npos) << piped.err;
}

TEST_F(SceneInputs, MessagesCallStandardOutputByItsName) {
  ASSERT_EQ(run_voxdag({"build", mesh_, "-r", "32", "-o", dag_}).status, 0);
  expect_failure(shell("$VOXDAG export a.vdag -o -"), 1,
                 "standard output: --format EXT is needed: EXT is an extension of .spc.npy");
  for (const std::string command :
       {"build mesh.obj -r 16", "convert a.vdag", "export a.vdag --format glb"}) {
    const ProcessResult result = shell("$VOXDAG " + command + " -o -");
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err.find("/proc/"), result.err.npos) << result.err;
    EXPECT_NE(result.err.find("standard output: "), result.err.npos) << result.err;
  }
}

TEST_F(SceneInputs, ADefaultNameNeverReplacesAnotherKindOfFile) {
  write_text(dir_ / "mesh.vdag", "my diary");
  expect_failure(shell("$VOXDAG build mesh.obj -r 16"), 2, "mesh.vdag exists");
  EXPECT_EQ(read_text(dir_ / "mesh.vdag"), "my diary");
  expect_failure(shell("$VOXDAG build --format obj - -r 16 < mesh.obj"), 2,
                 "--output: is required");
}

}  // namespace
}  // namespace voxdag::cli
