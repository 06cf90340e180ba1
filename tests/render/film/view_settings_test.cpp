#include "voxdag/render/film/view_settings.hpp"

#include <gtest/gtest.h>

#include "support/error_of.hpp"
#include "support/temp_dir.hpp"

namespace voxdag {
namespace {

class Settings : public testing::Test {
 protected:
  ViewSettings read(const std::string& json) {
    write_text(file_, json);
    return read_view_settings(file_);
  }
  /// Returns the error without the name of the file.
  std::string error(const std::string& json) {
    const std::string text = error_of([&] { read(json); });
    EXPECT_TRUE(text.starts_with(file_ + ": ")) << text;
    return text.substr(file_.size() + 2);
  }

  const TempDir dir_;
  const std::string file_ = dir_ / "view.json";
};

TEST_F(Settings, MissingKeysHaveTheDefaultsOfRender) {
  const ViewSettings settings = read("{}");
  const RenderOptions usual;
  EXPECT_FALSE(settings.options.view.eye);
  EXPECT_FALSE(settings.options.sun);
  EXPECT_EQ(settings.options.with_sun, usual.with_sun);
  EXPECT_EQ(settings.options.sun_degrees, usual.sun_degrees);
  EXPECT_EQ(settings.options.occlusion_samples, usual.occlusion_samples);
  EXPECT_EQ(settings.options.lod_pixels, usual.lod_pixels);
  EXPECT_EQ(settings.options.exposure, 0);
  EXPECT_FALSE(settings.options.section.box || settings.options.section.plane);
  EXPECT_TRUE(settings.colors && settings.normals && settings.ignored.empty());
}

TEST_F(Settings, ChannelsHaveANameAndARange) {
  EXPECT_EQ(read("{}").channel, "");
  const ViewSettings settings = read(R"({"channel": {"name": "heat", "range": [-1.5, 20]}})");
  EXPECT_EQ(settings.channel, "heat");
  EXPECT_EQ(settings.channel_range->least, -1.5);
  EXPECT_EQ(settings.channel_range->most, 20);
  EXPECT_FALSE(read(R"({"channel": {"name": "", "range": null}})").channel_range);
  for (const std::string range : {"[2, 2]", "[2]", "[-1e308, 2]", "[2, 3.5e38]", "[2, null]"})
    EXPECT_EQ(error(R"({"channel": {"range": )" + range + "}}"),
              "\"channel.range\" is not an array of two numbers in the range of floats, the "
              "smaller one first");
  EXPECT_EQ(error(R"({"channel": {"name": 1}})"), "\"channel.name\" is not a text");
}

TEST_F(Settings, EveryKeyIsRead) {
  const ViewSettings settings = read(R"({"version": 1,
    "camera": {"eye": [1, 2, 3], "target": [4, 5, 6], "up": [0, 0, 1], "fov": 55.5},
    "sun": {"direction": [1, 1, 0], "angle": 2, "on": false},
    "sky": 0.5, "exposure": 3, "shadows": false,
    "tone": "agx", "background": "white", "ground": false,
    "occlusion": {"samples": 16, "distance": 2.5, "cone": 0.07},
    "lod": 2, "cubes": 12, "level": null, "colors": false, "normals": false, "show": "light",
    "section": {"box": {"low": [-1, -2, -3], "high": [1, 2, 3]},
                "plane": {"point": [7, 8, 9], "normal": [0, -2, 0]}}, "mode": "fly",
    "measures": [{"from": [0, 0, 0], "to": [1, 1, 1]}], "annotations": [], "path": []})");
  const RenderOptions& options = settings.options;
  EXPECT_EQ(options.view.eye, (Vec3d{1, 2, 3}));
  EXPECT_EQ(options.view.target, (Vec3d{4, 5, 6}));
  EXPECT_EQ(options.view.up, (Vec3d{0, 0, 1}));
  EXPECT_EQ(options.view.vertical_fov_degrees, 55.5);
  EXPECT_EQ(options.sun, (Vec3d{1, 1, 0}));
  EXPECT_EQ(options.sun_degrees, 2);
  EXPECT_FALSE(options.with_sun);
  EXPECT_EQ(options.sky, 0.5f);
  EXPECT_EQ(options.exposure, 3);
  EXPECT_EQ(options.tone, ToneMap::kAgx);
  EXPECT_EQ(options.background, Background::kWhite);
  EXPECT_FALSE(options.ground);
  EXPECT_FALSE(options.shadows);
  EXPECT_EQ(options.occlusion_samples, 16);
  EXPECT_EQ(options.occlusion_distance, 2.5);
  EXPECT_EQ(options.occlusion_cone, 0.07);
  EXPECT_EQ(options.lod_pixels, 2);
  EXPECT_EQ(options.cube_pixels, 12);
  ASSERT_TRUE(options.section.box && options.section.plane);
  EXPECT_EQ(options.section.box->lo, (Vec3d{-1, -2, -3}));
  EXPECT_EQ(options.section.box->hi, (Vec3d{1, 2, 3}));
  EXPECT_EQ(options.section.plane->point, (Vec3d{7, 8, 9}));
  EXPECT_EQ(normalized(options.section.plane->normal), (Vec3d{0, -1, 0}));
  EXPECT_FALSE(settings.colors || settings.normals);
  EXPECT_TRUE(settings.ignored.empty());
}

TEST_F(Settings, ACameraHasTheDefaultsOfTheViewer) {
  const ViewRequest view =
      read(R"({"camera": {"eye": [0, 0, 5], "target": [0, 0, 0]}})").options.view;
  EXPECT_EQ(view.up, (Vec3d{0, 1, 0}));
  EXPECT_EQ(view.vertical_fov_degrees, 40);
}

TEST_F(Settings, SettingsThatAPictureCannotShowAreNamed) {
  const auto ignored = [this](const std::string& json) { return read(json).ignored.at(0); };
  EXPECT_EQ(ignored(R"({"level": 5})"), "\"level\" is ignored: a picture shows the finest level");
  EXPECT_TRUE(ignored(R"({"show": "steps"})").starts_with("\"show\" is ignored: "));
  EXPECT_EQ(ignored(R"({"fog": 1})"), "\"fog\" is ignored: the key is unknown");
  EXPECT_EQ(ignored(R"({"sun": {"size": 1}})"), "\"sun.size\" is ignored: the key is unknown");
}

TEST_F(Settings, APageHasATitleAndALicence) {
  const ViewSettings settings = read(R"({"title": "Castle", "licence": "CC BY 4.0", "unit": "m",
    "measures": [{"kind": "area", "points": [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}],
    "annotations": [{"text": "a", "point": [0, 0, 0], "camera": {"eye": [0, 0, 1], "target": [0, 0, 0]}}],
    "path": [{"time": 0, "eye": [0, 0, 1], "target": [0, 0, 0]}]})");
  EXPECT_EQ(settings.title, "Castle");
  EXPECT_EQ(settings.licence, "CC BY 4.0");
  EXPECT_TRUE(settings.ignored.empty() && settings.unknown.empty());
  EXPECT_EQ(read(R"({"fog": 1, "sun": {"size": 1}})").unknown,
            (std::vector<std::string>{"fog", "sun.size"}));
}

TEST_F(Settings, ErrorsInListsNameTheElement) {
  EXPECT_EQ(error(R"({"title": 1})"), "\"title\" is not a text");
  EXPECT_EQ(error(R"({"mode": "swim"})"), "\"mode\" is none of orbit, fly, walk");
  EXPECT_EQ(error(R"({"unit": "km"})"), "\"unit\" is none of m, cm, mm, in, ft");
  EXPECT_EQ(error(R"({"measures": {}})"), "\"measures\" is not an array");
  EXPECT_EQ(error(R"({"measures": [{"from": [0, 0, 0]}]})"), "\"measures[0].to\" is missing");
  EXPECT_EQ(error(R"({"measures": [{"kind": "area", "points": [[0, 0, 0]]}]})"),
            "\"measures[0].points\" has less than 2 points");
  EXPECT_EQ(error(R"({"measures": [{"points": [[0, 0, 0], [0, 1]]}]})"),
            "\"measures[0].points[1]\" is not an array of three numbers");
  EXPECT_EQ(error(R"({"annotations": [{"text": "a", "point": [0, 0, 0]}]})"),
            "\"annotations[0].camera\" is missing");
  EXPECT_EQ(error(R"({"path": [{"eye": [0, 0, 1], "target": [0, 0, 0]}]})"),
            "\"path[0].time\" is missing");
}

TEST_F(Settings, ErrorsNameTheKey) {
  EXPECT_EQ(error("[]"), "must be an object");
  EXPECT_EQ(error(R"({"version": 2})"), "\"version\" is 2; this program reads version 1");
  EXPECT_EQ(error(R"({"sky": "blue"})"), "\"sky\" is not a number");
  EXPECT_EQ(error(R"({"sky": -1})"), "\"sky\" is -1; allowed are 0 to 1000000");
  EXPECT_EQ(error(R"({"shadows": 1})"), "\"shadows\" is not true or false");
  EXPECT_EQ(error(R"({"sun": true})"), "\"sun\" is not an object");
  EXPECT_EQ(error(R"({"sun": {"direction": [0, 0, 0]}})"),
            "\"sun.direction\" must be a direction: finite and not zero");
  EXPECT_EQ(error(R"({"sun": {"angle": 90}})"), "\"sun.angle\" is 90; allowed are 0 to 89");
  EXPECT_EQ(error(R"({"camera": {"eye": [1, 2]}})"),
            "\"camera.eye\" is not an array of three numbers");
  EXPECT_EQ(error(R"({"camera": {"eye": [1, 2, 3]}})"), "\"camera.target\" is missing");
  EXPECT_EQ(error(R"({"camera": {"eye": [1, 2, 3], "target": [1, 2, 3]}})"),
            "\"camera\" has eye and target at one point");
  EXPECT_EQ(error(R"({"camera": {"eye": [0, 1, 0], "target": [0, 0, 0]}})"),
            "\"camera.up\" points along the view");
  EXPECT_EQ(error(R"({"occlusion": {"samples": 1.5}})"),
            "\"occlusion.samples\" is not a whole number");
  EXPECT_EQ(error(R"({"section": {"plane": {"point": [0, 0, 0]}}})"),
            "\"section.plane.normal\" is missing");
  EXPECT_EQ(error(R"({"section": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 0]}}})"),
            "\"section.plane.normal\" must be a direction: finite and not zero");
  EXPECT_EQ(error(R"({"section": {"box": {"low": [0, 0, 0]}}})"),
            "\"section.box.high\" is missing");
  EXPECT_EQ(error(R"({"section": {"box": {"low": [0, 2, 0], "high": [1, 1, 1]}}})"),
            "\"section.box\" has its low corner above its high one");
  EXPECT_EQ(error(R"({"section": 5})"), "\"section\" is not an object");
  EXPECT_TRUE(error("{").starts_with("byte ")) << error("{");
  EXPECT_EQ(error(R"({"sky": 1e999})"), "a number is out of range");
}

}  // namespace
}  // namespace voxdag
