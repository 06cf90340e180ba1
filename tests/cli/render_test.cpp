#include <fstream>
#include <nlohmann/json.hpp>

#include "npy_rays.hpp"
#include "sponge.hpp"
#include "support/read_pictures.hpp"
#include "voxdag/image/exr.hpp"

namespace voxdag::cli {
namespace {

class RenderCommand : public Sponge {};

TEST_F(RenderCommand, WritesPngAndExr) {
  const ProcessResult result =
      run_voxdag({"render", path("in.vdag"), "-o", path("a.png"), "--size", "64x36", "--depth",
                  path("z.exr"), "--normal", path("n.exr")});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("--eye"), std::string::npos);
  EXPECT_EQ(read_text(path("a.png")).substr(1, 3), "PNG");
  for (const char* name : {"z.exr", "n.exr"})
    EXPECT_EQ(read_text(path(name)).substr(0, 4), "\x76\x2f\x31\x01") << name;
}

TEST_F(RenderCommand, WritesEveryPassInBothFormats) {
  std::vector<std::string> words = {"render", path("in.vdag"), "-o",   path("p.exr"),
                                    "--size", "40x30",         "--ao", "4"};
  const std::vector<std::string> names = {"picture", "radiance", "depth",   "normal", "occlusion",
                                          "shadow",  "steps",    "steps64", "albedo", "voxel"};
  for (const std::string& name : names)
    for (const char* extension : {".png", ".exr"}) {
      words.push_back("--pass");
      words.push_back(name + "=" + path(name + extension));
    }
  const ProcessResult result = run_voxdag(words);
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("steps per primary ray"), std::string::npos);
  for (const std::string& name : names) {
    EXPECT_EQ(read_rgb8(path(name + ".png")).width, 40) << name;
    EXPECT_EQ(read_exr(path(name + ".exr")).image.height, 30) << name;
  }
  for (const float part : read_exr(path("occlusion.exr")).image.pixels) {
    EXPECT_GE(part, 0);
    EXPECT_LE(part, 1);
  }
}

TEST_F(RenderCommand, BeamsChangeNothingAndLightsDo) {
  const auto render = [](std::vector<std::string> options, const std::string& name) {
    options.insert(options.begin(),
                   {"render", path("in.vdag"), "-o", path(name), "--size", "64x36", "--ao", "4"});
    EXPECT_EQ(run_voxdag(options).status, 0);
    return read_text(path(name));
  };
  const std::string plain = render({"--sun-angle", "5", "--spp", "2"}, "plain.png");
  EXPECT_EQ(render({"--sun-angle", "5", "--spp", "2", "--no-beams"}, "whole.png"), plain);
  for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{
           {"--light", "point:3,3,-3"},
           {"--light", "sphere:3,3,-3,1,9,9,9"},
           {"--light", "disc:3,3,-3,-1,-1,1,1", "--light", "rect:2,3,-2,1,0,0,0,0,1"},
           {"--no-sun"},
           {"--sky", "0.5"},
           {"--specular", "0.3"},
           {"--specular", "0.3:200", "--light", "point:3,3,-3"},
           {"--ao-distance", "0.2"},
           {"--exposure", "0.1"}}) {
    std::vector<std::string> words = {"--spp", "2"};
    if (options[0] != "--no-sun") words.insert(words.end(), {"--sun-angle", "5"});
    words.insert(words.end(), options.begin(), options.end());
    EXPECT_NE(render(words, "other.png"), plain) << options[0];
  }
}

TEST_F(RenderCommand, TheFilterIsForOctreesUnlessAskedFor) {
  ASSERT_EQ(run_voxdag({"build", path("sponge.ply"), "-r", "16", "-o", path("in.esvo")}).status, 0);
  const auto render = [](const std::string& file, std::vector<std::string> options) {
    options.insert(options.begin(),
                   {"render", path(file), "-o", path("f.png"), "--size", "64x36", "--ao", "4"});
    EXPECT_EQ(run_voxdag(options).status, 0);
    return read_text(path("f.png"));
  };
  for (const char* file : {"in.vdag", "in.esvo"}) {
    const bool is_esvo = std::string(file) == "in.esvo";
    const std::string usual = render(file, {});
    const std::string with = render(file, {"--filter"}), without = render(file, {"--no-filter"});
    EXPECT_NE(with, without) << file;
    EXPECT_EQ(usual, is_esvo ? with : without) << file;
    const std::string plain = render(file, {"--filter-kind", "plain"});
    const std::string naive = render(file, {"--filter-kind", "naive", "--filter"});
    EXPECT_EQ(render(file, {"--filter-kind", "guided"}), with) << file;
    EXPECT_NE(plain, with) << file;
    EXPECT_NE(naive, with) << file;
    EXPECT_NE(naive, plain) << file;
    EXPECT_NE(naive, without) << file;
  }
}

TEST_F(RenderCommand, TakesTheViewThatItPrints) {
  const auto render = [](std::vector<std::string> options, const std::string& name) {
    options.insert(options.begin(),
                   {"render", path("in.vdag"), "-o", path(name), "--size", "64x36"});
    return run_voxdag(options);
  };
  const std::vector<std::string> view = {"--eye", "3,2.5,-4", "--target", "0.5,0.5,0.5",
                                         "--up",  "0,1,0",    "--fov",    "40"};
  const ProcessResult first = render(view, "first.png");
  ASSERT_EQ(first.status, 0) << first.err;
  for (const std::string& word : view) EXPECT_NE(first.out.find(word), std::string::npos) << word;
  ASSERT_EQ(render(view, "second.png").status, 0);
  EXPECT_EQ(read_text(path("first.png")), read_text(path("second.png")));
}

TEST_F(RenderCommand, TakesTheCameraThatItWrites) {
  const auto render = [&](std::vector<std::string> options, const std::string& name) {
    options.insert(options.begin(), {"render", path("in.vdag"), "-o", path(name), "--size", "64x36",
                                     "--pass", "voxel=" + path(name + ".exr")});
    return run_voxdag(options);
  };
  const ProcessResult first = render({"--write-camera", path("c.json")}, "first.png");
  ASSERT_EQ(first.status, 0) << first.err;
  const ProcessResult second = render({"--camera-matrix", path("c.json")}, "second.png");
  ASSERT_EQ(second.status, 0) << second.err;
  EXPECT_EQ(read_exr(path("first.png.exr")).image, read_exr(path("second.png.exr")).image);
  expect_failure(render({"--camera-matrix", path("c.json"), "--eye", "1,2,3"}, "bad.png"), 2,
                 "--camera-matrix");
  write_text(path("c.json"), "{}");
  expect_failure(render({"--camera-matrix", path("c.json")}, "bad.png"), 1, "c.json");
}

TEST_F(RenderCommand, AnEnvironmentLightsThePicture) {
  const auto render = [&](const std::string& environment, const std::string& name) {
    return run_voxdag({"render", path("in.vdag"), "-o", path(name), "--size", "64x36", "--ao", "4",
                       "--background", "black", "--environment", environment});
  };
  ImageF red(64, 32, 3);
  for (std::size_t i = 0; i < red.pixels.size(); i += 3) red.pixels[i] = 5;
  write_exr(path("red.exr"), red, {"R", "G", "B"});
  const ProcessResult result = render(path("red.exr"), "red.png");
  ASSERT_EQ(result.status, 0) << result.err;
  const ImageRgb8 picture = read_rgb8(path("red.png"));
  int lit = 0;
  for (std::size_t i = 0; i < picture.pixels.size(); i += 3) {
    lit += picture.pixels[i] > 60 ? 1 : 0;
    EXPECT_LE(picture.pixels[i + 1], picture.pixels[i] / 2 + 2);
  }
  EXPECT_GT(lit, 50);
  EXPECT_EQ(render("studio", "studio.png").status, 0);
  expect_failure(render(path("none.hdr"), "bad.png"), 1, "none.hdr");
  expect_failure(render(path("in.vdag"), "bad.png"), 1, "neither a Radiance HDR nor an OpenEXR");
}

TEST_F(RenderCommand, PathsAndMaterialsAreRefusedWhereThereAreNone) {
  const std::string in = path("in.vdag"), out = path("bad.png");
  expect_failure(run_voxdag({"render", in, "-o", out, "--bounces", "1", "--ao", "0"}), 2,
                 "--bounces");
  expect_failure(run_voxdag({"render", in, "-o", out, "--pass", "material=" + path("m.png")}), 1,
                 "material ids");
}

TEST_F(RenderCommand, RefusesWhatMakesNoPicture) {
  const std::string in = path("in.vdag"), out = path("bad.png");
  expect_failure(run_voxdag({"render", in, "-o", path("bad.jpg")}), 2, ".png or .exr");
  expect_failure(run_voxdag({"render", in, "-o", out, "--size", "0x10"}), 2, "--size");
  expect_failure(run_voxdag({"render", in, "-o", out, "--eye", "1,2"}), 2, "--eye");
  expect_failure(run_voxdag({"render", in, "-o", out, "--eye", "1,1,1", "--target", "1,1,1"}), 2,
                 "--target");
  write_text(path("bad.ply"), "ply\nformat ascii 1.0\n");
  expect_failure(run_voxdag({"render", path("bad.ply"), "-o", out}), 1, "bad.ply");
  expect_failure(run_voxdag({"render", in, "-o", out, "--pass", "depth"}), 2, "NAME=FILE");
  expect_failure(run_voxdag({"render", in, "-o", out, "--pass", "colour=a.png"}), 2, "not one of");
  expect_failure(run_voxdag({"render", in, "-o", out, "--pass", "depth=z.tif"}), 2, ".png or .exr");
  expect_failure(run_voxdag({"render", in, "-o", out, "--light", "tube:1,2,3"}), 2, "sphere:");
  expect_failure(run_voxdag({"render", in, "-o", out, "--light", "sphere:1,2,3"}), 2, "4 numbers");
  expect_failure(run_voxdag({"render", in, "-o", out, "--light", "sphere:1,2,3,0"}), 2, "radius");
  expect_failure(run_voxdag({"render", in, "-o", out, "--filter-kind", "soft"}), 2,
                 "--filter-kind: \"soft\" is neither guided nor plain nor naive");
  expect_failure(run_voxdag({"render", in, "-o", out, "--specular", "0.3:0"}), 2,
                 "--specular: \"0\" is not a whole number from 1 to 10000");
  expect_failure(run_voxdag({"render", in, "-o", out, "--specular", "1.1"}), 2,
                 "--specular: \"1.1\" is not a number from 0 to 1");
  EXPECT_FALSE(exists("bad.png"));
}

TEST_F(RenderCommand, SeesTheTrianglesOfAMesh) {
  const auto render = [](std::vector<std::string> more) {
    more.insert(more.begin(), {"render", path("in.vdag"), "-o", path("mesh.png"), "--size", "64x36",
                               "--ao", "4"});
    return run_voxdag(more);
  };
  expect_failure(render({"--primary", "mesh"}), 2, "--mesh");
  expect_failure(render({"--mesh", path("absent.ply")}), 1, "absent.ply");
  ASSERT_EQ(render({}).status, 0);
  const std::string voxels = read_text(path("mesh.png"));
  ASSERT_EQ(render({"--mesh", path("sponge.ply"), "--primary", "voxels"}).status, 0);
  EXPECT_EQ(read_text(path("mesh.png")), voxels);
  ASSERT_EQ(run_voxdag({"scene", "hairball", "--size", "1", "-o", path("hair.ply")}).status, 0);
  expect_failure(render({"--mesh", path("hair.ply")}), 1, "hair.ply: the ");
  const ProcessResult result = render({"--mesh", path("sponge.ply"), "--primary", "mesh"});
  if (result.status != 0) {
    expect_failure(result, 1, "libembree-dev");
    return;
  }
  EXPECT_NE(read_text(path("mesh.png")), voxels);
}

TEST_F(RenderCommand, TakesEsvoFiles) {
  ASSERT_EQ(
      run_voxdag({"build", path("sponge.ply"), "-r", "32", "--as", "esvo", "-o", path("in.esvo")})
          .status,
      0);
  const auto render = [](const std::string& option, const std::string& name) {
    std::vector<std::string> words = {"render", path("in.esvo"), "-o",   path(name),
                                      "--size", "64x36",         "--ao", "4"};
    if (!option.empty()) words.push_back(option);
    const ProcessResult result = run_voxdag(words);
    EXPECT_EQ(result.status, 0) << result.err;
    return read_text(path(name));
  };
  const std::string picture = render("", "esvo.png");
  EXPECT_EQ(render("--no-beams", "esvo_whole.png"), picture);
  EXPECT_NE(render("--no-sun", "esvo_night.png"), picture);

  // Two rays at a corner of the sponge, whose side is 0.56, and one that points away from it.
  std::ofstream(path("rays.npy"), std::ios::binary)
      << rays_npy({{0.03f, 0.03f, 9, 0, 0, 0, -1, 1e9f},
                   {0.03f, 9, 0.03f, 0, 0, -1, 0, 1e9f},
                   {9, 9, 9, 0, 1, 0, 0, 1e9f}});
  const ProcessResult traced =
      run_voxdag({"trace", path("in.esvo"), "--rays", path("rays.npy"), "-o", path("hits.npy")});
  EXPECT_EQ(traced.status, 0) << traced.err;
  EXPECT_NE(traced.out.find("3 rays, 2 hits"), std::string::npos) << traced.out;
}

TEST_F(RenderCommand, OcclusionCanBeBakedIntoAnEsvo) {
  ASSERT_EQ(run_voxdag(
                {"build", path("sponge.ply"), "-r", "32", "--as", "esvo", "-o", path("plain.esvo")})
                .status,
            0);
  const ProcessResult baked = run_voxdag({"build", path("sponge.ply"), "-r", "32", "--as", "esvo",
                                          "--bake-ao", "16", "-o", path("baked.esvo")});
  ASSERT_EQ(baked.status, 0) << baked.err;
  const ProcessResult info = run_voxdag({"info", path("baked.esvo"), "--json"});
  EXPECT_EQ(nlohmann::json::parse(info.out).at("build").at("bake_ao_rays"), "16");
  const auto picture = [&](const std::string& name) {
    EXPECT_EQ(run_voxdag({"render", path(name + ".esvo"), "-o", path(name + ".png"), "--size",
                          "64x48", "--ao", "0", "--exposure", "1"})
                  .status,
              0);
    return read_text(path(name + ".png"));
  };
  EXPECT_NE(picture("plain"), picture("baked"));
}

TEST_F(RenderCommand, BakedOcclusionIsThatOfTheOctreesOwnVoxelsUnlessAskedFor) {
  const auto build = [](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"build", path("sponge.ply"), "-r", "32", "--bake-ao", "16",
                                      "-o",    path("ao.esvo")};
    words.insert(words.end(), more.begin(), more.end());
    const ProcessResult result = run_voxdag(words);
    EXPECT_EQ(result.status, 0) << result.err;
    const ProcessResult info = run_voxdag({"info", path("ao.esvo"), "--json"});
    return std::pair(nlohmann::json::parse(info.out).at("build").at("bake_ao_resolution"),
                     read_text(path("ao.esvo")));
  };
  const auto [usual, bytes] = build({});
  EXPECT_EQ(usual, "32");
  EXPECT_EQ(build({"--ao-resolution", "32"}), std::pair(usual, bytes));
  const auto [coarse, coarse_bytes] = build({"--ao-resolution", "8"});
  EXPECT_EQ(coarse, "8");
  EXPECT_NE(coarse_bytes, bytes);
}

}  // namespace
}  // namespace voxdag::cli
