#include <gtest/gtest.h>

#include <sstream>

#include "process.hpp"
#include "support/temp_dir.hpp"

namespace voxdag::cli {
namespace {

/// A tetrahedron with a colour in each corner.
constexpr const char* kColoredMesh =
    "v 1 2 3 1 0 0\nv 5 2 3 0 1 0\nv 1 4 3 0 0 1\nv 1 2 5 1 1 0\n"
    "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

class WrittenOutput : public testing::Test {
 protected:
  WrittenOutput() {
    write_text(mesh_, kColoredMesh);
    write_text(points_, "0 0 0\n1 2 3\n3 1 2\n");
  }

  TempDir dir_;
  std::string mesh_ = dir_ / "mesh.obj", points_ = dir_ / "points.xyz", dag_ = dir_ / "a.vdag";
};

TEST_F(WrittenOutput, BuildMakesTheFilesThatExportMakesOfItsDag) {
  ASSERT_EQ(run_voxdag({"build", mesh_, "-r", "32", "--color", "-o", dag_}).status, 0);
  for (const std::string ending : {".glb", ".vox", ".ply", ".npy", ".stl", ".html"}) {
    const std::string at_once = dir_ / ("one" + ending), exported = dir_ / ("two" + ending);
    const ProcessResult built = run_voxdag({"build", mesh_, "-r", "32", "-o", at_once});
    EXPECT_EQ(built.status, 0) << built.err;
    EXPECT_EQ(built.err, "");
    ASSERT_EQ(run_voxdag({"export", dag_, "-o", exported}).status, 0);
    EXPECT_TRUE(read_text(at_once) == read_text(exported)) << ending;
  }
}

TEST_F(WrittenOutput, BuildMakesThePictureThatRenderMakesOfItsDag) {
  ASSERT_EQ(run_voxdag({"build", mesh_, "-r", "32", "--color", "-o", dag_}).status, 0);
  const std::string at_once = dir_ / "one.png", rendered = dir_ / "two.png";
  ASSERT_EQ(run_voxdag({"build", mesh_, "-r", "32", "-o", at_once}).status, 0);
  ASSERT_EQ(run_voxdag({"render", dag_, "-o", rendered}).status, 0);
  EXPECT_TRUE(read_text(at_once) == read_text(rendered));
}

TEST_F(WrittenOutput, ImportMakesOtherFilesToo) {
  ASSERT_EQ(run_voxdag({"import", points_, "-r", "16", "-o", dag_}).status, 0);
  ASSERT_EQ(run_voxdag({"export", dag_, "-o", dir_ / "two.ply"}).status, 0);
  const ProcessResult imported =
      run_voxdag({"import", points_, "-r", "16", "-o", dir_ / "one.ply"});
  EXPECT_EQ(imported.status, 0) << imported.err;
  EXPECT_EQ(read_text(dir_ / "one.ply"), read_text(dir_ / "two.ply"));
}

TEST_F(WrittenOutput, OtherEndingsAreBadUsageAndWriteNothing) {
  const long before = dir_.count();
  for (const std::string name : {"out.docx", "out", "out.VDAG", "out.vdag.gz"}) {
    expect_failure(run_voxdag({"build", mesh_, "-o", dir_ / name}), 2, ".vdag, .esvo, .png");
    expect_failure(run_voxdag({"import", points_, "-o", dir_ / name}), 2, ".glb");
  }
  EXPECT_EQ(dir_.count(), before);
}

TEST_F(WrittenOutput, NoDagIsWrittenUnderTheNameOfAnotherFormat) {
  ASSERT_EQ(run_voxdag({"build", mesh_, "-r", "32", "-o", dag_}).status, 0);
  // The message lists what export writes.
  std::istringstream words(run_voxdag({"build", mesh_, "-o", dir_ / "out.docx"}).err);
  std::vector<std::string> endings = {".esvo", ".html", ".GLB"};
  for (std::string word; words >> word;)
    if (word.starts_with('.') && word != ".vdag," && word != ".png," && word != ".exr,")
      endings.push_back(word.substr(0, word.find(',')));
  EXPECT_GE(endings.size(), 23U);
  for (const std::string& ending : endings) {
    const std::string out = dir_ / ("out" + ending);
    expect_failure(run_voxdag({"convert", dag_, "-o", out}), 1, "voxdag export");
    EXPECT_FALSE(std::filesystem::exists(out)) << ending;
  }
  const std::string out = dir_ / "out.glb";
  for (const std::vector<std::string>& command :
       std::vector<std::vector<std::string>>{{"coarsen", dag_, "--by", "1"},
                                             {"crop", dag_, "--window", "0,0,0,8,8,8"},
                                             {"edit", dag_, "--do", "add,ball,1,2,3,1"},
                                             {"dilate", dag_, "--steps", "1"},
                                             {"components", dag_, "--largest"},
                                             {"combine", dag_, dag_, "--union"},
                                             {"view", dag_, "--edit"}}) {
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.end(), {"-o", out});
    const ProcessResult result = run_voxdag(arguments);
    expect_failure(result, 1, "voxdag export");
    EXPECT_NE(result.err.find("out.glb"), result.err.npos) << result.err;
  }
  for (const std::string name : {"out.bin", "out", "out.VDAG", "out.vdag.bak"})
    EXPECT_EQ(run_voxdag({"convert", dag_, "-o", dir_ / name}).status, 0) << name;
}

TEST_F(WrittenOutput, OptionsThatContradictTheEndingAreBadUsage) {
  const auto build = [&](const std::string& name, const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {"build", mesh_, "-r", "32", "-o", dir_ / name};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run_voxdag(arguments);
  };
  expect_failure(build("a.esvo", {"--as", "dag"}), 2, "ends in .esvo");
  expect_failure(build("a.glb", {"--as", "esvo"}), 2, "--as esvo");
  expect_failure(build("a.glb", {"--stats"}), 2, "--stats");
  expect_failure(build("a.png", {"--json"}), 2, "--json");
  expect_failure(build("a.glb", {"--parts", "2"}), 2, "--parts");
  expect_failure(run_voxdag({"import", points_, "-o", dir_ / "a.esvo"}), 2, ".esvo");
}

TEST_F(WrittenOutput, MessagesNeverShowTheTemporaryFile) {
  write_text(points_, "nan nan nan\n");
  const ProcessResult result = run_voxdag({"import", points_, "-r", "16", "-o", dir_ / "out.glb"});
  EXPECT_EQ(result.err.find("/proc/"), result.err.npos) << result.err;
  EXPECT_NE(result.err.find("points.xyz"), result.err.npos) << result.err;
}

TEST_F(WrittenOutput, ColoursAreStoredOnlyIfThereAreSome) {
  const std::string plain = dir_ / "plain.obj";
  write_text(plain, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto colors_of = [&](const std::string& mesh, const std::string& option) {
    const ProcessResult result = run_voxdag({"build", mesh, "-r", "16", "-o", dag_, option});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err.find("has no colours") != result.err.npos,
              mesh == plain && option == "--color")
        << result.err;
    return run_voxdag({"info", dag_, "--json"}).out.find("\"color\"") != std::string::npos;
  };
  EXPECT_TRUE(colors_of(mesh_, "--color-if-any"));
  EXPECT_FALSE(colors_of(plain, "--color-if-any"));
  EXPECT_TRUE(colors_of(plain, "--color"));
}

TEST_F(WrittenOutput, TextureGivesAMeshTheColoursOfAnImage) {
  const std::string plain = dir_ / "plain.obj", textured = dir_ / "textured.obj",
                    image = dir_ / "red.png", cube = dir_ / "cube.obj";
  write_text(plain, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write_text(textured, "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
  write_text(cube, "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3\n");
  // A picture that is red: the texture of an export of a red triangle.
  ASSERT_EQ(run_voxdag({"build", cube, "-r", "8", "--color", "-o", dag_}).status, 0);
  ASSERT_EQ(run_voxdag({"export", dag_, "--texture", "-o", dir_ / "red.obj"}).status, 0);
  const ProcessResult built =
      run_voxdag({"build", textured, "-r", "8", "--texture", image, "-o", dir_ / "t.vdag"});
  EXPECT_EQ(built.status, 0) << built.err;
  EXPECT_EQ(built.err, "");
  for (const std::string name : {"t", "a"})
    ASSERT_EQ(run_voxdag({"export", dir_ / (name + ".vdag"), "-o", dir_ / (name + ".ply")}).status,
              0);
  EXPECT_EQ(read_text(dir_ / "t.ply"), read_text(dir_ / "a.ply"));
  expect_failure(run_voxdag({"build", plain, "--texture", image, "-o", dir_ / "p.vdag"}), 1,
                 "has no texture coordinates");
  expect_failure(run_voxdag({"build", textured, "--texture", dir_ / "no.png", "-o", dag_}), 1,
                 "no.png");
}

}  // namespace
}  // namespace voxdag::cli
