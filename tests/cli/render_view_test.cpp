/// Tests render --view, which reads the settings of the viewer.
#include "colored_waves.hpp"
#include "sponge.hpp"

namespace voxdag::cli {
namespace {

class RenderView : public Sponge {
 protected:
  /// Renders with these settings. Returns the picture's bytes.
  static std::string with_settings(const std::string& json, std::vector<std::string> more = {}) {
    write_text(path("view.json"), json);
    more.insert(more.end(), {"--view", path("view.json")});
    return picture(more);
  }
  static std::string picture(const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {"render", path("in.vdag"), "-o", path("view.png"),
                                          "--size", "48x32",         "-q"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ProcessResult result = run_voxdag(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "");
    return read_text(path("view.png"));
  }
};

constexpr const char* kCamera =
    R"("camera": {"eye": [2, 1, 2], "target": [0.3, 0.3, 0.3], "up": [0, 1, 0], "fov": 50})";
const std::vector<std::string> kCameraOptions = {"--eye", "2,1,2", "--target", "0.3,0.3,0.3",
                                                 "--up",  "0,1,0", "--fov",    "50"};

std::vector<std::string> with_camera(std::vector<std::string> options) {
  options.insert(options.end(), kCameraOptions.begin(), kCameraOptions.end());
  return options;
}

TEST_F(RenderView, GivesThePictureOfTheOptions) {
  EXPECT_EQ(with_settings("{}"), picture({}));
  EXPECT_EQ(with_settings(R"({"hidden": []})"), picture({}));
  EXPECT_EQ(with_settings(std::string("{") + kCamera + "}"), picture(kCameraOptions));
  EXPECT_EQ(with_settings(std::string("{") + kCamera +
                          R"(, "sun": {"direction": [1, 2, 3], "angle": 4}, "sky": 0.5,
                          "exposure": 2, "occlusion": {"samples": 8, "distance": 0.2, "cone": 0.1},
                          "lod": 0, "cubes": 3})"),
            picture(with_camera({"--sun", "1,2,3", "--sun-angle", "4", "--sky", "0.5", "--exposure",
                                 "2", "--ao", "8", "--ao-distance", "0.2", "--ao-cone", "0.1",
                                 "--lod", "0", "--cubes", "3"})));
  EXPECT_EQ(with_settings(std::string("{") + kCamera + R"(, "sun": {"on": false}})"),
            picture(with_camera({"--no-sun"})));
  EXPECT_EQ(with_settings(std::string("{") + kCamera + R"(, "shadows": false})"),
            picture(with_camera({"--no-shadows"})));
}

TEST_F(RenderView, ASectionCutsThePicture) {
  const std::string box = R"("section": {"box": {"low": [0, 0, 0.1], "high": [1, 0.5, 1]}})";
  const std::string plane = R"("section": {"plane": {"point": [0.4, 0, 0], "normal": [1, 0, 0]}})";
  const std::string cut = with_settings(std::string("{") + kCamera + ", " + box + "}");
  EXPECT_EQ(cut, picture(with_camera({"--section-box", "0,0,0.1,1,0.5,1"})));
  EXPECT_NE(cut, picture(kCameraOptions));
  EXPECT_EQ(with_settings(std::string("{") + kCamera + ", " + plane + "}"),
            picture(with_camera({"--section-plane", "0.4,0,0,1,0,0"})));
  EXPECT_EQ(with_settings(std::string("{") + kCamera + ", " + box + "}",
                          {"--section-box", "0,0,0,1,1,0.6"}),
            picture(with_camera({"--section-box", "0,0,0,1,1,0.6"})));
  const auto refused = [&](const std::string& option, const std::string& text,
                           const std::string& reason) {
    expect_failure(run_voxdag({"render", path("in.vdag"), "-o", path("no.png"), option, text}), 2,
                   reason);
  };
  refused("--section-plane", "1,2,3", "six numbers");
  refused("--section-plane", "1,2,3,0,0,0", "length is zero");
  refused("--section-box", "1,0,0,0,1,1", "second corner");
}

TEST_F(RenderView, LightsByAnEnvironment) {
  EXPECT_EQ(with_settings(R"({"environment": {"map": "studio", "turn": 30}})"),
            picture({"--environment", "studio", "--environment-turn", "30"}));
  EXPECT_EQ(with_settings(R"({"environment": {"map": "studio", "turn": 30}})",
                          {"--environment", "sunset"}),
            picture({"--environment", "sunset", "--environment-turn", "30"}));
  EXPECT_EQ(with_settings(R"({"bounces": 2, "occlusion": {"samples": 8}})"),
            picture({"--bounces", "2", "--ao", "8"}));
  EXPECT_EQ(with_settings(R"({"bounces": null, "environment": {"map": null}})"), picture({}));
}

TEST_F(RenderView, OptionsWinOverTheFile) {
  const std::string settings = std::string("{") + kCamera +
                               R"(, "sun": {"direction": [1, 2, 3], "angle": 4, "on": false},
                               "sky": 0.5, "exposure": 2, "occlusion": {"samples": 8}, "lod": 0})";
  EXPECT_EQ(with_settings(settings, {"--fov", "30", "--sky", "1"}),
            picture({"--eye", "2,1,2", "--target", "0.3,0.3,0.3", "--up", "0,1,0", "--fov", "30",
                     "--no-sun", "--sky", "1", "--exposure", "2", "--ao", "8", "--lod", "0"}));
  EXPECT_EQ(with_settings(settings, {"--sun", "0,1,0"}),
            picture(with_camera({"--sun", "0,1,0", "--sun-angle", "4", "--sky", "0.5", "--exposure",
                                 "2", "--ao", "8", "--lod", "0"})));
}

TEST_F(RenderView, ErrorsNameFileAndKey) {
  const std::string file = path("view.json");
  const auto refused = [&](const std::string& json, const std::string& text) {
    write_text(file, json);
    expect_failure(run_voxdag({"render", path("in.vdag"), "-o", path("no.png"), "--view", file}), 1,
                   file + ": " + text);
    EXPECT_FALSE(exists("no.png"));
  };
  refused(R"({"sky": true})", "\"sky\" is not a number");
  refused(R"({"environment": {"map": "moon"}})",
          "\"environment.map\" is none of studio, overcast, sunset and a map");
  refused(R"({"environment": {"map": {"name": "a", "side": 2, "texels": "", "sun": [0, 0, 0]}}})",
          "\"environment.map.towards\" is missing");
  const auto refused_map = [&](const std::string& side, const std::string& texels,
                               const std::string& text) {
    refused(R"({"environment": {"map": {"name": "a", "towards": [0, 0, 0], "sun": [0, 0, 0],
            "side": )" +
                side + R"(, "texels": ")" + texels + "\"}}}",
            text);
  };
  refused_map("2.5", "", "\"environment.map.side\" is no whole number from 2 to 512");
  refused_map("2", "AAAA", "\"environment.map.texels\" is not the base64 of 16 bytes");
  refused_map("2", "AAAAAAAAAAAAAAAAAAAAAA==", "the environment is black");
  refused(R"({"bounces": 1.5})", "\"bounces\" is not a whole number");
  refused(R"({"section": {"box": {"low": [0, 0, 0]}}})", "\"section.box.high\" is missing");
  expect_failure(
      run_voxdag({"render", path("in.vdag"), "-o", path("no.png"), "--view", path("none.json")}), 1,
      "cannot open");
  expect_failure(run_voxdag({"render", path("in.vdag"), "-o", file, "--view", file}), 2, "");
}

TEST_F(RenderView, ColoursAndNormalsAreLeftOut) {
  const std::string mesh = path("waves.obj"), colored = path("colored.vdag"),
                    grey = path("grey.vdag"), out = path("out.png"), view = path("view.json");
  write_text(mesh, colored_waves());
  ASSERT_EQ(
      run_voxdag({"build", mesh, "-r", "32", "--color", "--normal", "-o", colored, "-q"}).status,
      0);
  ASSERT_EQ(run_voxdag({"convert", colored, "--drop-attributes", "-o", grey, "-q"}).status, 0);
  const auto render = [&](const std::string& file, const std::string& settings) {
    write_text(view, settings);
    EXPECT_EQ(
        run_voxdag({"render", file, "-o", out, "--size", "48x32", "-q", "--view", view}).status, 0);
    return read_text(out);
  };
  const std::string plain = render(grey, "{}");
  EXPECT_EQ(render(colored, R"({"colors": false, "normals": false})"), plain);
  EXPECT_NE(render(colored, "{}"), plain);
  EXPECT_NE(render(colored, R"({"colors": false})"), plain);
}

TEST_F(RenderView, MaterialsWinOverTheFile) {
  const std::string mesh = path("strips.obj"), dag = path("strips.vdag"), out = path("strips.png"),
                    view = path("view.json");
  write_text(mesh, colored_waves(true));
  ASSERT_EQ(run_voxdag({"build", mesh, "-r", "32", "--material-ids", "-o", dag, "-q"}).status, 0);
  const auto render = [&](const std::string& settings, std::vector<std::string> more) {
    write_text(view, settings);
    more.insert(more.begin(), {"render", dag, "-o", out, "--size", "48x32", "-q", "--view", view});
    EXPECT_EQ(run_voxdag(more).status, 0);
    return read_text(out);
  };
  const std::string shown = render("{}", {"--materials"});
  EXPECT_EQ(render(R"({"colors": false})", {"--materials"}), shown);
  EXPECT_NE(render("{}", {}), shown);
}

TEST_F(RenderView, SettingsThatAPictureCannotShowAreNamed) {
  write_text(path("view.json"),
             R"({"level": 3, "show": "steps", "bounces": 1, "occlusion": {"samples": 0},
             "hidden": [1]})");
  const ProcessResult result = run_voxdag({"render", path("in.vdag"), "-o", path("a.png"), "--size",
                                           "8x8", "-q", "--view", path("view.json")});
  EXPECT_EQ(result.status, 0);
  EXPECT_NE(result.err.find("\"level\" is ignored"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("\"show\" is ignored"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("\"bounces\" is ignored"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("\"hidden\" is ignored"), std::string::npos) << result.err;
}

TEST_F(RenderView, AChannelBesideAMeshIsNamed) {
  write_text(path("view.json"), R"({"channel": {"name": "heat"}})");
  const ProcessResult result =
      run_voxdag({"render", path("in.vdag"), "-o", path("a.png"), "--size", "8x8", "-q", "--view",
                  path("view.json"), "--mesh", path("sponge.ply")});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.err.find("\"channel\" is ignored: --mesh shows no channels"), std::string::npos)
      << result.err;
}

}  // namespace
}  // namespace voxdag::cli
