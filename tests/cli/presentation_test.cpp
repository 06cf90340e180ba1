// The up axis, the unit and the home view of files, through all commands that make files.
#include <gtest/gtest.h>

#include "json.hpp"
#include "process.hpp"
#include "support/temp_dir.hpp"

namespace voxdag::cli {
namespace {

using Json = nlohmann::json;

class PresentationOfFiles : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return dir_ / name; }
  static std::string run(const std::vector<std::string>& arguments) {
    const ProcessResult result = run_voxdag(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    return result.out;
  }
  Json info(const std::string& name) const {
    return Json::parse(run({"info", path(name), "--json"}));
  }
  std::string summary_of(const std::string& name) const {
    return run({"render", path(name), "-o", path("a.png"), "--size", "32x18", "--ao", "0"});
  }
  /// Returns the options of the view that `render` chooses.
  std::string view_of(const std::string& name) const {
    const std::string out = summary_of(name);
    return out.substr(out.find("--eye"));
  }
  TempDir dir_;
};

TEST_F(PresentationOfFiles, FollowTheFormatTheOptionOrTheShape) {
  // A plate that stands on its edge: nothing in it tells which way is up.
  write_text(path("a.obj"), "v 0 0 0\nv 3 0 0\nv 3 0 8\nv 0 1 8\nf 1 2 3\nf 1 3 4\n");
  write_text(path("a.stl"),
             "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 3 1 0\nvertex 2 5 4\n"
             "endloop\nendfacet\nendsolid\n");
  run({"build", path("a.obj"), "-r", "32", "-o", path("y.vdag")});
  EXPECT_EQ(info("y.vdag").at("up"), "y");
  EXPECT_EQ(info("y.vdag").at("up_guessed"), true);
  EXPECT_FALSE(info("y.vdag").contains("unit"));
  run({"build", path("a.obj"), "-r", "32", "--up", "x:z", "--unit", "mm", "-o", path("x.vdag")});
  EXPECT_EQ(info("x.vdag").at("up"), "z");
  EXPECT_EQ(info("x.vdag").at("unit"), "mm");
  run({"build", path("a.stl"), "-r", "32", "-o", path("z.vdag")});
  EXPECT_EQ(info("z.vdag").at("up"), "z");
  EXPECT_EQ(info("z.vdag").at("home").at("up"), Json::array({0, 0, 1}));
  EXPECT_NE(view_of("z.vdag").find("--up 0,0,1 "), std::string::npos);
  EXPECT_NE(view_of("y.vdag").find("--up 0,1,0 "), std::string::npos);
  // A guess is never printed as if it were known, also not after an edit.
  run({"combine", path("y.vdag"), path("y.vdag"), "--union", "-o", path("yy.vdag")});
  run({"build", path("a.obj"), "-r", "32", "--up", "y:y", "-o", path("told.vdag")});
  for (const char* name : {"y.vdag", "yy.vdag", "told.vdag", "x.vdag", "z.vdag"}) {
    const bool is_guessed = *name == 'y';
    EXPECT_EQ(info(name).contains("up_guessed"), is_guessed) << name;
    const auto says = [&](const std::string& text) {
      return text.find("guessed") != text.npos && text.find("--up sets it") != text.npos;
    };
    EXPECT_EQ(says(run({"info", path(name)})), is_guessed) << name;
    EXPECT_EQ(says(summary_of(name)), is_guessed) << name;
  }
  EXPECT_EQ(run({"render", path("y.vdag"), "-o", path("a.png"), "--size", "32x18", "--up", "0,1,0"})
                .find("guessed"),
            std::string::npos);
  // The bytes do not depend on the number of threads.
  run({"build", path("a.stl"), "-r", "32", "--threads", "1", "-o", path("one.vdag")});
  EXPECT_EQ(read_text(path("one.vdag")), read_text(path("z.vdag")));
}

TEST_F(PresentationOfFiles, SurviveEveryEdit) {
  write_text(path("a.xyz"), "0 0 0\n1 5 2\n4 1 1\n2 2 6\n");
  run({"import", path("a.xyz"), "-r", "32", "--unit", "cm", "-o", path("a.vdag")});
  const Json first = info("a.vdag");
  EXPECT_EQ(first.at("up"), "z");
  EXPECT_EQ(first.at("unit"), "cm");
  EXPECT_FALSE(first.contains("cubes"));
  run({"convert", path("a.vdag"), "--compact", "-o", path("compact.vdag")});
  run({"coarsen", path("a.vdag"), "--by", "1", "-o", path("coarse.vdag")});
  run({"combine", path("a.vdag"), path("a.vdag"), "--union", "-o", path("both.vdag")});
  for (const char* name : {"compact.vdag", "coarse.vdag", "both.vdag"}) {
    const Json json = info(name);
    for (const char* key : {"up", "unit", "home"}) EXPECT_EQ(json.at(key), first.at(key)) << name;
  }
}

TEST_F(PresentationOfFiles, VoxelsAreCubesUnlessAnOptionSaysOtherwise) {
  write_text(path("b.binvox"), [] {
    std::string bytes = "#binvox 1\ndim 8 8 8\ndata\n";
    for (int i = 0; i < 4; ++i) bytes += {i % 2 == 0 ? '\1' : '\0', static_cast<char>(128)};
    return bytes;
  }());
  run({"import", path("b.binvox"), "-o", path("b.vdag")});
  EXPECT_EQ(info("b.vdag").at("cubes"), true);
  const auto picture = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {"render", path("b.vdag"), "-o",   path("b.png"),
                                          "--size", "64x48",        "--ao", "0"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    run(arguments);
    return read_text(path("b.png"));
  };
  EXPECT_EQ(picture({}), picture({"--cubes", "0"}));
  EXPECT_NE(picture({}), picture({"--cubes", "100"}));
}

TEST_F(PresentationOfFiles, ATransparentBackgroundIsWrittenAsAlpha) {
  write_text(path("a.xyz"), "0 0 0\n1 5 2\n4 1 1\n2 2 6\n");
  run({"import", path("a.xyz"), "-r", "8", "-o", path("a.vdag")});
  const auto color_type = [&](const std::string& background) {
    run({"render", path("a.vdag"), "-o", path("a.png"), "--size", "32x18", "--background",
         background});
    return static_cast<int>(read_text(path("a.png"))[25]);
  };
  EXPECT_EQ(color_type("transparent"), 6);  // RGB with alpha
  EXPECT_EQ(color_type("sky"), 2);
  EXPECT_EQ(
      run_voxdag({"render", path("a.vdag"), "-o", path("a.png"), "--background", "red"}).status, 2);
}

}  // namespace
}  // namespace voxdag::cli
