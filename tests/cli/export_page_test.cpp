#include "city_dag.hpp"
#include "colored_waves.hpp"

namespace voxdag::cli {
namespace {

using ExportPage = CityDag;

TEST_F(ExportPage, AFolderAndAFile) {
  const ProcessResult folder = run_voxdag({"export", plain_, "-o", dir_ / "site/"});
  EXPECT_EQ(folder.status, 0) << folder.err;
  EXPECT_TRUE(folder.out.starts_with((dir_ / "site/").string() + ": ")) << folder.out;
  EXPECT_EQ(read_text(dir_ / "site/scene.vdag"), read_text(plain_));
  const ProcessResult file = run_voxdag({"export", small_, "-o", dir_ / "a.html"});
  EXPECT_EQ(file.status, 0) << file.err;
  EXPECT_EQ(file.err, "");
  EXPECT_TRUE(read_text(dir_ / "a.html").starts_with("<!doctype html>"));
}

TEST_F(ExportPage, WithoutASceneItBeginsWithTheStartPage) {
  const std::string site = dir_ / "site/", page = dir_ / "a.html";
  EXPECT_EQ(run_voxdag({"export", "-o", site, "--title", "Drop here"}).status, 0);
  EXPECT_FALSE(std::filesystem::exists(site + "scene.vdag"));
  const std::string index = read_text(site + "index.html");
  for (const char* part : {"<title>Drop here</title>", "default-src 'none'", "connect-src 'self'",
                           R"(id="scene"></script>)"})
    EXPECT_NE(index.find(part), std::string::npos) << part;
  EXPECT_EQ(run_voxdag({"export", "-o", page}).status, 0);
  EXPECT_NE(read_text(page).find(R"(id="scene"></script>)"), std::string::npos);
  expect_failure(run_voxdag({"export", "-o", dir_ / "a.glb"}), 2, "FILE");
  for (const std::string option : {"--poster", "--levels=5"})
    expect_failure(run_voxdag({"export", "-o", page, option}), 2, "without FILE");
}

TEST_F(ExportPage, LevelsMakeItCoarser) {
  ASSERT_EQ(run_voxdag({"convert", plain_, "--levels", "5", "-o", dir_ / "5.vdag"}).status, 0);
  ASSERT_EQ(run_voxdag({"export", plain_, "--levels", "5", "-o", dir_ / "site/"}).status, 0);
  EXPECT_EQ(read_text(dir_ / "site/scene.vdag"), read_text(dir_ / "5.vdag"));
  expect_failure(run_voxdag({"export", plain_, "--levels", "9", "-o", dir_ / "b/"}), 1,
                 "has 8 levels, 256 voxels a side: it cannot get 9");
  expect_failure(run_voxdag({"export", plain_, "--levels", "5", "-o", dir_ / "a.npy"}), 2,
                 "--levels");
}

TEST_F(ExportPage, LevelsKeepTheColours) {
  const std::string mesh = dir_ / "waves.obj", colored = dir_ / "colored.vdag",
                    coarse = dir_ / "coarse.vdag";
  write_text(mesh, colored_waves());
  ASSERT_EQ(
      run_voxdag({"build", mesh, "-r", "32", "--color", "--normal", "-o", colored, "-q"}).status,
      0);
  const std::vector<std::string> reduction = {"--levels", "4", "--color-bound", "0.02"};
  const auto write = [&](std::vector<std::string> words) {
    words.insert(words.end(), reduction.begin(), reduction.end());
    const ProcessResult result = run_voxdag(words);
    EXPECT_EQ(result.status, 0) << result.err;
  };
  write({"convert", colored, "--wire", "-o", coarse, "-q"});
  write({"export", colored, "-o", dir_ / "site/", "-q"});
  EXPECT_EQ(read_text(dir_ / "site/scene.vdag"), read_text(coarse));
  EXPECT_NE(run_voxdag({"info", coarse, "--json"}).out.find("\"color\""), std::string::npos);
}

TEST_F(ExportPage, AViewATitleAndAPosterAreBakedIn) {
  const std::string view = dir_ / "view.json";
  write_text(view, R"({"sky": 2, "annotations": [{"text": "</script><b>", "point": [0, 0, 0],
    "camera": {"eye": [0, 0, 1], "target": [0, 0, 0]}}]})");
  const auto exported = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"export", small_, "-o", dir_ / "a.html", "-q"});
    const ProcessResult result = run_voxdag(words);
    EXPECT_EQ(result.status, 0) << result.err;
    return read_text(dir_ / "a.html");
  };
  const std::string plain = exported({}),
                    baked = exported({"--view", view, "--title", "A & <B>", "--poster"});
  EXPECT_NE(baked.find("<title>A &amp; &lt;B></title>"), std::string::npos);
  EXPECT_NE(baked.find(R"("sky":2,"title":"A & \u003cB>")"), std::string::npos);
  EXPECT_NE(baked.find(R"("text":"\u003c/script>\u003cb>")"), std::string::npos);
  EXPECT_NE(baked.find("<img class=\"poster\" alt=\"\" src=\"data:image/jpeg;base64,/9j/"),
            std::string::npos);
  EXPECT_EQ(plain.find("class=\"poster\""), std::string::npos);
  EXPECT_LT(baked.size(), plain.size() + 100'000);
  EXPECT_EQ(baked, exported({"--view", view, "--title", "A & <B>", "--poster"}));
  ASSERT_EQ(run_voxdag({"export", small_, "-o", dir_ / "site/", "--view", view}).status, 0);
  EXPECT_NE(read_text(dir_ / "site/index.html").find(R"("sky":2)"), std::string::npos);
}

TEST_F(ExportPage, AnEnvironmentIsBakedIn) {
  const std::string view = dir_ / "view.json", page = dir_ / "a.html", light = dir_ / "light.hdr";
  std::string sky = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n";
  for (int i = 0; i < 8; ++i) sky += std::string("\x60\x70\x80\x81", 4);
  write_text(light, sky);
  write_text(view, R"({"sky": 2, "environment": {"map": "sunset", "turn": 30}})");
  const auto exported = [&](const std::string& environment) {
    EXPECT_EQ(run_voxdag({"export", small_, "-o", page, "-q", "--view", view, "--environment",
                          environment, "--poster"})
                  .status,
              0);
    return read_text(page);
  };
  EXPECT_NE(exported("studio").find(R"("environment":{"map":"studio","turn":30},"sky":2)"),
            std::string::npos);
  const std::string baked = exported(light);
  EXPECT_NE(baked.find(R"("environment":{"map":{"name":"light.hdr","side":16,"sun":[0.0,0.0,0.0])"),
            std::string::npos);
  // 16² texels of the picture's bytes.
  EXPECT_NE(baked.find(R"("texels":"YHCAgWBwgIFgcICB)"), std::string::npos);
  expect_failure(run_voxdag({"export", small_, "-o", page, "--environment", dir_ / "no.hdr"}), 1,
                 "no.hdr: cannot open");
  expect_failure(run_voxdag({"export", small_, "-o", dir_ / "a.ply", "--environment", "studio"}), 2,
                 "--environment");
}

TEST_F(ExportPage, AWrongViewIsRefused) {
  const std::string view = dir_ / "view.json";
  const auto expect_refused = [&](const std::string& json, const std::string& reason) {
    write_text(view, json);
    expect_failure(run_voxdag({"export", small_, "-o", dir_ / "a.html", "--view", view}), 1,
                   view + ": " + reason);
    expect_failure(run_voxdag({"view", small_, "--no-open", "--view", view}), 1,
                   view + ": " + reason);
  };
  expect_refused(R"({"sun": {"size": 1}})", "\"sun.size\" is an unknown key");
  expect_refused(R"({"sky": "blue"})", "\"sky\" is not a number");
  expect_refused(R"({"measures": [{}]})", "\"measures[0].from\" is missing");
  expect_refused("{\"sky\": }", "byte 9");
  EXPECT_FALSE(std::filesystem::exists(dir_ / "a.html"));
  expect_failure(run_voxdag({"export", small_, "-o", dir_ / "a.ply", "--poster"}), 2, "--poster");
}

TEST_F(ExportPage, WrongOutputsAreRefused) {
  expect_failure(run_voxdag({"export", plain_, "-o", dir_.path()}), 2, "is the folder of");
  expect_failure(run_voxdag({"export", plain_, "-o", dir_ / "no/site/"}), 1, "cannot create");
  expect_failure(run_voxdag({"export", plain_, "-o", dir_ / "no/a.html"}), 1, "no/a.html");
  expect_failure(run_voxdag({"export", plain_, "-o", dir_ / "a.xyz"}), 1, "cannot export");
  expect_failure(run_voxdag({"export", plain_, "-o", dir_ / "a.html", "--faces"}), 2, "--faces");
}

}  // namespace
}  // namespace voxdag::cli
