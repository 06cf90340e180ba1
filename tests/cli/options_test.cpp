/// Tests of refused command lines: wrong values, options without effect, outputs that overwrite
/// each other.
#include <filesystem>
#include <sstream>

#include "sponge.hpp"

namespace voxdag::cli {
namespace {

using Words = std::vector<std::string>;

class Options : public Sponge {
 protected:
  static ProcessResult render(Words more, const std::string& name = "bad.png") {
    more.insert(more.begin(), {"render", path("in.vdag"), "-o", path(name), "--size", "48x32"});
    return run_voxdag(more);
  }
  static ProcessResult build(Words more, const std::string& name) {
    more.insert(more.begin(), {"build", path("sponge.ply"), "-r", "16", "-o", path(name)});
    return run_voxdag(more);
  }
  static ProcessResult film(Words more) {
    write_text(path("keys.json"), R"({"keys": [{"time": 0, "eye": [2,1,2], "target": [0,0,0]}]})");
    more.insert(more.begin(), {"--path", path("keys.json")});
    return render(more, "f%d.png");
  }
  /// Expects that each of these options, by itself, is bad usage, and that the error names the
  /// option.
  template <class Command>
  static void expect_refused(const std::vector<Words>& cases, const Command& command) {
    for (const Words& words : cases) {
      SCOPED_TRACE(testing::PrintToString(words));
      expect_failure(command(words), 2, words[0]);
    }
    EXPECT_EQ(files_like("bad"), 0);
  }
};

TEST_F(Options, NumbersAreFiniteAndInTheirRange) {
  expect_refused({{"--exposure", "0"},
                  {"--exposure", "nan"},
                  {"--exposure", "inf"},
                  {"--exposure", "1e300"},
                  {"--lod", "nan"},
                  {"--sky", "nan"},
                  {"--specular", "nan"},
                  {"--specular", "-0.1"},
                  {"--specular", ":20"},
                  {"--specular", "0.3:"},
                  {"--specular", "0.3:1.5"},
                  {"--specular", "0.3:10001"},
                  {"--specular", "0.3:20:1"},
                  {"--ao-cone", "nan"},
                  {"--sun-angle", "nan"},
                  {"--fov", "180"},
                  {"--fov", "360"},
                  {"--fov", "0"},
                  {"--spp", "1.5"}},
                 [](const Words& words) { return render(words); });
  expect_refused({{"--max-error", "nan"}, {"--color-error", "nan"}, {"--normal-error", "nan"}},
                 [](const Words& words) { return build(words, "bad.esvo"); });
  expect_failure(render({"--exposure", "0"}), 2,
                 "--exposure: \"0\" is not a number above 0 and finite");
  expect_failure(render({"--spp", "1.5"}), 2, "\"1.5\" is not a whole number from 1 to 4096");
  expect_failure(run_voxdag({"scene", "sponge", "-o", path("bad.ply"), "--seed", "-1"}), 2,
                 "--seed: \"-1\" is not a whole number");
}

TEST_F(Options, ViewsAndLightsAreCheckedAtOnce) {
  expect_refused({{"--up", "0,0,0"},
                  {"--sun", "0,0,0"},
                  {"--target", "1,1,1", "--eye", "1,1,1"},
                  {"--up", "0,1,0", "--eye", "0,5,0", "--target", "0,0,0"},
                  {"--eye", "1e300,0,0"},
                  {"--light", "sphere:1,2,3,0"},
                  {"--light", "disc:1,2,3,0,0,0,1"},
                  {"--light", "point:1,2,3,1,-1,1"},
                  {"--light", "rect:1,2,3,1,0,0,2,0,0"}},
                 [](const Words& words) { return render(words); });
  Words lamps;
  for (int i = 0; i < 16; ++i) lamps.insert(lamps.end(), {"--light", "point:1,2,3"});
  expect_failure(render(lamps), 2, "--light: is given 16 times; at most 15 are allowed");
}

TEST_F(Options, OutputsToTheSameFileAreRefused) {
  const std::string roundabout = (std::filesystem::path(path(".")) / "." / "bad.png").string();
  expect_refused({{"--pass depth", "--pass", "depth=" + roundabout}}, [](const Words& words) {
    return render({words.begin() + 1, words.end()});
  });
  expect_refused({{"--depth", path("bad.png")}, {"--normal", path("bad.png")}},
                 [](const Words& words) { return render(words); });
  expect_failure(film({"--pass", "depth=" + path("f%d.png")}), 2, "--pass depth: would overwrite");
  const std::string both = path("bad.json");
  if (has_lab())
    expect_failure(run_voxdag({"bench", "trace", path("in.vdag"), "-o", both, "--plot", both}), 2,
                   "--plot: would overwrite");
  EXPECT_EQ(files_like("f0"), 0);
}

TEST_F(Options, FramesOfAFilmHaveDistinctNames) {
  write_text(path("long.json"), R"({"keys": [{"time": 0, "eye": [2,1,2], "target": [0,0,0]},
                                             {"time": 3, "eye": [2,2,2], "target": [0,0,0]}]})");
  expect_failure(
      run_voxdag({"render", path("in.vdag"), "--path", path("long.json"), "--fps", "4", "-o",
                  path("g%d.png"), "--size", "48x32", "--pass", "depth=" + path("g1%d.png")}),
      1, "two files of the film have this name");
  EXPECT_EQ(files_like("g"), 0);
}

TEST_F(Options, WithoutEffectAreRefused) {
  expect_refused({{"--filter", "--no-filter"},
                  {"--filter-kind", "plain", "--no-filter"},
                  {"--mesh", path("sponge.ply"), "--filter"},
                  {"--mesh", path("sponge.ply"), "--filter-kind", "naive"},
                  {"--fps", "5"},
                  {"--timings", path("bad.csv")},
                  {"--grey"},
                  {"--eye", "1,2,3", "--path", "keys.json"},
                  {"--target", "1,2,3", "--path", "keys.json"}},
                 [](const Words& words) { return render(words); });
  expect_failure(render({}, "bad%d.png"), 2, "only --path");
  for (const Words& option : std::vector<Words>{{"--displace", "stone:1"},
                                                {"--no-displacement"},
                                                {"--max-error", "1"},
                                                {"--color-error", "1"},
                                                {"--normal-error", "1"},
                                                {"--bake-ao"},
                                                {"--no-contours"},
                                                {"--no-attributes"}})
    expect_failure(build(option, "bad.vdag"), 2, option[0] + ": is for ESVOs only");
  expect_failure(build({"--method", "sort"}, "bad.esvo"), 2, "--method: is for DAGs only");
  expect_failure(build({"--ao-distance", "1"}, "bad.esvo"), 2,
                 "--ao-distance: has no effect without --bake-ao");
  expect_failure(build({"--ao-resolution", "8"}, "bad.esvo"), 2,
                 "--ao-resolution: has no effect without --bake-ao");
  expect_failure(build({"--bake-ao", "--ao-resolution", "1000"}, "bad.esvo"), 2, "power of two");
  expect_failure(build({"--bake-ao", "--ao-resolution", "4K"}, "bad.esvo"), 2,
                 "--ao-resolution: 4096 is more than the ESVO's resolution, ");
  expect_failure(run_voxdag({"build", path("sponge.ply"), "--voxel-size", "0.1", "--bake-ao",
                             "--ao-resolution", "4096", "-o", path("bad.esvo")}),
                 1, "--ao-resolution: 4096 is more than the ESVO's resolution, ");
  expect_failure(build({"--bake-ao", "8", "--no-attributes"}, "bad.esvo"), 2, "--no-attributes");
  expect_failure(run_voxdag({"scene", "sponge", "--view", "-o", path("bad.ply")}), 2, "--view");
  expect_failure(run_voxdag({"scene", "sponge", "--view", "--json"}), 2, "--json");
  expect_failure(run_voxdag({"scene", "--list", "sponge"}), 2, "--list");
  expect_failure(run_voxdag({"verify", path("in.vdag"), "--samples", "10"}), 2, "--mesh");
  expect_failure(run_voxdag({"export", path("in.vdag"), "--faces", "-o", path("bad.npy")}), 2,
                 "--faces");
  if (has_lab())
    expect_failure(run_voxdag({"bench", "trace", path("in.vdag"), "-r", "64"}), 2, "--resolution");
  EXPECT_EQ(files_like("bad"), 0);
}

TEST_F(Options, SwitchedOffByAnotherOptionAreRefused) {
  const auto expect_no_effect = [](const ProcessResult& result, const std::string& text) {
    expect_failure(result, 2, text);
  };
  const struct {
    Words words;
    const char* text;
  } pictures[] = {
      {{"--sun", "1,1,1", "--no-sun"}, "--sun: has no effect with --no-sun"},
      {{"--sun-angle", "1", "--no-sun"}, "--sun-angle: has no effect with --no-sun"},
      {{"--shadow-samples", "4", "--no-shadows"}, "--shadow-samples: has no effect with --no-sh"},
      {{"--shadow-samples", "4", "--sun-angle", "0"}, "without a light with soft edges"},
      {{"--shadow-samples", "4", "--no-sun", "--light", "point:1,2,3"}, "with soft edges"},
      {{"--no-shadows", "--no-sun"}, "--no-shadows: has no effect without sun and lights"},
      {{"--specular", "0.3", "--no-sun"}, "--specular: has no effect without sun and lights"},
      {{"--ao-distance", "1", "--ao", "0"}, "--ao-distance: has no effect with --ao 0"},
      {{"--ao-cone", "0.07", "--ao", "0"}, "--ao-cone: has no effect with --ao 0"},
      {{"--allow-outside"}, "--allow-outside: has no effect without --mesh"},
      {{"--assimp", "any"}, "--assimp: has no effect without --mesh"},
      {{"--mesh", "a.ply", "--grey", "--primary", "voxels"}, "with --primary voxels"}};
  for (const auto& [words, text] : pictures) expect_no_effect(render(words), text);
  for (const Words& error : std::vector<Words>{{"--color-error", "0.1"}, {"--normal-error", "5"}})
    for (const char* off : {"--no-contours", "--no-attributes"})
      expect_no_effect(build({error[0], error[1], off}, "bad.esvo"),
                       error[0] + ": has no effect with " + off);
  expect_no_effect(build({"--max-error", "1", "--no-contours"}, "bad.esvo"), "with --no-contours");
  expect_no_effect(build({"--stats", "--json"}, "bad.vdag"), "--stats: has no effect with --json");
  expect_no_effect(build({"--stats", "--quiet"}, "bad.vdag"), "--stats: has no effect with --qui");
  for (const Words& words :
       std::vector<Words>{{"--seed", "2"}, {"--size", "2"}, {"--quiet", "--json"}})
    expect_no_effect(run_voxdag({"scene", "--list", words[0], words[1]}), "with --list");
  expect_no_effect(run_voxdag({"scene", "hairball", "--path", "--seed", "2"}), "with --path");
  expect_no_effect(run_voxdag({"scene", "sponge", "--seed", "2", "-o", path("bad.ply")}),
                   "--seed: has no effect on this scene");
  expect_no_effect(
      run_voxdag({"verify", path("in.vdag"), "--mesh", "a", "--samples", "0", "--seed", "2"}),
      "--seed: has no effect with --samples 0");
  if (has_lab())
    expect_no_effect(run_voxdag({"bench", "build", "--rival-seconds", "5"}), "without --rival");
  EXPECT_EQ(files_like("bad"), 0);
}

TEST_F(Options, AnEmptyValueAfterAnEqualsSignIsRefused) {
  expect_failure(build({"--bake-ao="}, "bad.esvo"), 2, "--bake-ao: is empty");
  expect_failure(build({"--method=", "sort"}, "bad.vdag"), 2, "--method: is empty");
}

TEST_F(Options, WorkOfDaysIsRefusedWithTheMaximum) {
  expect_failure(film({"--fps", "1000000"}), 2,
                 "--fps: \"1000000\" is not a number above 0, at most 1000");
  expect_failure(run_voxdag({"verify", path("in.vdag"), "--mesh", path("sponge.ply"), "--samples",
                             "4294967296"}),
                 2, "is not a whole number from 0 to 1000000000");
}

TEST_F(Options, AViewIsRefusedForTheRightReason) {
  EXPECT_EQ(render({"--eye", "1e38,1e38,1e38"}, "far.png").status, 0);
  EXPECT_EQ(render({"--eye", "2,1,2", "--up", "0.6,0.5,0.4"}, "up.png").status, 0);
  expect_failure(render({"--fov", "1e-320"}), 2, "--fov: \"1e-320\" is not a number from 1e-06");
  expect_failure(render({"--eye", "1e-200,0,0", "--target", "0,0,0"}), 2, "is too close to --eye");
}

TEST_F(Options, WithEmptyValuesAreRefused) {
  expect_refused({{"--mesh", ""}, {"--path", ""}, {"--depth", ""}, {"--light", ""}},
                 [](const Words& words) { return render(words); });
  expect_failure(run_voxdag({"verify", path("in.vdag"), "--mesh", ""}), 2, "--mesh: is empty");
  expect_failure(run_voxdag({"info", ""}), 2, "empty");
  expect_failure(run_voxdag({"build", path("sponge.ply"), "-r", "16", "-o", ""}), 2,
                 "--output: is empty");
}

TEST_F(Options, WordsOutsideTheListAreRefused) {
  for (const char* word : {"7", "1", "0", "HASH", "hashes"})
    expect_failure(build({"--method", word}, "bad.vdag"), 2, "is not hash, sort or paper");
  for (const char* word : {"2", "-1", "1e5", "svo"})
    expect_failure(build({"--as", word}, "bad.vdag"), 2, "is neither dag nor esvo");
  EXPECT_EQ(files_like("bad"), 0);
}

TEST_F(Options, AFilmsUpIsThatOfItsPath) {
  write_text(path("up.json"),
             R"({"keys": [{"time": 0, "eye": [2,1,2], "target": [0,0,0], "up": [0,1,0]}]})");
  expect_failure(run_voxdag({"render", path("in.vdag"), "--path", path("up.json"), "-o",
                             path("bad%d.png"), "--up", "0,0,1"}),
                 1, "up.json: key 0: has \"up\", so --up has no effect");
}

TEST_F(Options, MemoryIsForEsvos) {
  expect_failure(render({"--memory", "1M"}), 1, "in.vdag: --memory is for ESVOs only");
}

TEST_F(Options, TheMeshOfABenchmarkMustBelongToTheVoxels) {
  if (!has_lab()) GTEST_SKIP() << "built without voxdag-lab";
  ASSERT_EQ(run_voxdag({"scene", "hairball", "--size", "1", "-o", path("hair.ply")}).status, 0);
  expect_failure(run_voxdag({"bench", "trace", path("in.vdag"), "--mesh", path("hair.ply"),
                             "--size", "40x32", "--repeat", "1", "--views", "1"}),
                 1, "hair.ply: the ");
}

TEST_F(Options, AMissingFolderOfScenesIsNamed) {
  if (!has_lab()) GTEST_SKIP() << "built without voxdag-lab";
  expect_failure(run_voxdag({"bench", "trace", "--scenes", path("absent"), "-r", "64"}), 1,
                 path("absent") + ": No such file");
}

TEST_F(Options, AnEsvoMustBeWrittenToARegularFile) {
  expect_failure(
      run_voxdag({"build", path("absent.ply"), "-r", "16", "-o", "/dev/null", "--as", "esvo"}), 1,
      "/dev/null: an ESVO needs a regular file as its output");
}

TEST_F(Options, ThePrintedViewMakesTheSamePicture) {
  const ProcessResult first = render({"--ao", "4"}, "first.png");
  ASSERT_EQ(first.status, 0) << first.err;
  Words words = {"--ao", "4"};
  std::istringstream printed(first.out.substr(first.out.find("  --eye")));
  for (std::string word; printed >> word;) words.push_back(word);
  ASSERT_EQ(words.size(), 12u) << first.out;
  ASSERT_EQ(render(words, "second.png").status, 0);
  EXPECT_EQ(read_text(path("first.png")), read_text(path("second.png")));
}

}  // namespace
}  // namespace voxdag::cli
