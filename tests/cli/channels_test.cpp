// Channels from `voxdag import`, in reports, edits, pictures and exports.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "npy_rays.hpp"
#include "process.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/file/npy.hpp"

namespace voxdag::cli {
namespace {

class Channels : public testing::Test {
 protected:
  Channels() {
    // Two points in the first voxel.
    write_text(dir_ / "p.ply",
               "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
               "property float z\nproperty uchar intensity\nproperty float scalar_T\nend_header\n"
               "0 0 0 10 1.5\n0.2 0 0 13 2.5\n1 0 0 200 -4\n3 3 3 7 0.3\n");
  }
  std::string path(const std::string& name) const { return dir_ / name; }
  ProcessResult import(std::vector<std::string> more) const {
    std::vector<std::string> words{"import", path("p.ply"), "--voxel-size",
                                   "1",      "-o",          path("p.vdag")};
    words.insert(words.end(), more.begin(), more.end());
    return run_voxdag(words);
  }
  nlohmann::json channels(const std::string& name) const {
    const ProcessResult result = run_voxdag({"info", path(name), "--json"});
    EXPECT_EQ(result.status, 0) << result.err;
    return nlohmann::json::parse(result.out).at("attributes").at("channels");
  }

  TempDir dir_;
};

TEST_F(Channels, ImportKeepsFieldsAndInfoListsThem) {
  const ProcessResult result =
      import({"--channel", "intensity", "--channel", "scalar_T:as heat,bound=0.125"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("channels      intensity (u8), heat (f32)"), std::string::npos)
      << result.out;
  const nlohmann::json list = channels("p.vdag");
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0].at("name"), "intensity");
  EXPECT_EQ(list[0].at("kind"), "u8");
  EXPECT_EQ(list[0].at("least"), 7);
  EXPECT_EQ(list[0].at("greatest"), 200);
  EXPECT_EQ(list[1].at("name"), "heat");
  EXPECT_EQ(list[1].at("bound"), 0.125);
  EXPECT_EQ(list[1].at("least"), -4);
  EXPECT_EQ(list[1].at("greatest"), 2);
  EXPECT_EQ(run_voxdag({"verify", path("p.vdag")}).status, 0);
  EXPECT_NE(run_voxdag({"info", path("p.vdag")}).out.find("u8, 7 to 200"), std::string::npos);
}

TEST_F(Channels, EditsAndTheCompactFormKeepThem) {
  ASSERT_EQ(import({"--channel", "intensity"}).status, 0);
  EXPECT_EQ(
      run_voxdag({"crop", path("p.vdag"), "--window", "1,0,0,4,4,4", "-o", path("c.vdag")}).status,
      0);
  EXPECT_EQ(channels("c.vdag")[0].at("least"), 7);
  EXPECT_EQ(run_voxdag({"convert", path("p.vdag"), "--compact", "-o", path("k.vdag")}).status, 0);
  EXPECT_EQ(channels("k.vdag"), channels("p.vdag"));
  const ProcessResult edited =
      run_voxdag({"edit", path("p.vdag"), "--do", "add,ball,1,1,1,1.5", "-o", path("e.vdag")});
  EXPECT_EQ(edited.status, 0) << edited.err;
  EXPECT_EQ(channels("e.vdag")[0].at("greatest"), 200);
  EXPECT_EQ(run_voxdag({"verify", path("e.vdag")}).status, 0);
}

TEST_F(Channels, ExportsComeBackAndOtherFormatsSayThatTheyDropThem) {
  ASSERT_EQ(import({"--channel", "intensity", "--channel", "scalar_T"}).status, 0);
  for (const char* const name : {"out.ply", "out.npy"}) {
    EXPECT_EQ(run_voxdag({"export", path("p.vdag"), "-o", path(name)}).status, 0);
    EXPECT_EQ(run_voxdag({"import", path(name), "--channel", "intensity", "--channel", "scalar_T",
                          "-o", path("again.vdag")})
                  .status,
              0);
    EXPECT_EQ(channels("again.vdag"), channels("p.vdag")) << name;
  }
  const ProcessResult dropped = run_voxdag({"export", path("p.vdag"), "-o", path("out.obj")});
  EXPECT_EQ(dropped.status, 0);
  EXPECT_NE(dropped.err.find("the channels are left out"), std::string::npos) << dropped.err;
}

TEST_F(Channels, PicturesShowThemAsColours) {
  ASSERT_EQ(import({"--channel", "intensity"}).status, 0);
  const std::vector<std::string> render{
      "render", path("p.vdag"), "--size", "32x32",
      "-o",     path("o.png"),  "--pass", "albedo=" + path("a.png")};
  std::vector<std::string> words = render;
  words.insert(words.end(), {"--color-by", "intensity"});
  const ProcessResult result = run_voxdag(words);
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.err.find("intensity: 7 (violet) to 200 (yellow)"), std::string::npos)
      << result.err;
  words = render;
  words.insert(words.end(), {"--color-by", "heat"});
  expect_failure(run_voxdag(words), 1, "has no channel 'heat': its channels are intensity");
}

TEST_F(Channels, PicturesTakeThemFromAViewAndOptionsWin) {
  ASSERT_EQ(import({"--channel", "intensity", "--channel", "scalar_T"}).status, 0);
  write_text(dir_ / "view.json", R"({"channel": {"name": "scalar_T", "range": [-4, 2]}})");
  const auto picture = [&](std::vector<std::string> more) {
    std::vector<std::string> words{"render", path("p.vdag"), "--size",     "24x24",
                                   "-q",     "-o",           path("o.png")};
    words.insert(words.end(), more.begin(), more.end());
    const ProcessResult result = run_voxdag(words);
    EXPECT_EQ(result.status, 0) << result.err;
    return read_text(path("o.png"));
  };
  const std::string heat = picture({"--color-by", "scalar_T", "--range", "-4,2"});
  EXPECT_EQ(picture({"--view", path("view.json"), "--ground", "on"}),
            picture({"--color-by", "scalar_T", "--range", "-4,2", "--ground", "on"}));
  EXPECT_EQ(picture({"--view", path("view.json"), "--ground", "on", "--color-by", "intensity"}),
            picture({"--color-by", "intensity", "--ground", "on"}));
  EXPECT_NE(heat, picture({}));
}

TEST_F(Channels, TraceAndQueryWriteTheirValues) {
  ASSERT_EQ(import({"--channel", "intensity:as t", "--channel", "scalar_T"}).status, 0);
  // Along x from the left: the first voxel, and none.
  write_text(dir_ / "rays.npy", rays_npy({{-5, 0, 0, 0, 1, 0, 0, 100}, {-5, 9, 0, 0, 1, 0, 0, 9}}));
  const auto rows = [&](const std::string& dtype, std::size_t bytes) {
    NpyReader reader(path("out.npy"), dtype, {}, bytes);
    std::vector<std::string> all(reader.rows(), std::string(bytes, '\0'));
    for (std::string& row : all) reader.read_rows(row.data(), 1);
    return all;
  };
  const auto expect_values = [](const std::string& row, int intensity, float heat) {
    float stored = 0;
    std::memcpy(&stored, row.data() + row.size() - 4, 4);
    EXPECT_EQ(static_cast<unsigned char>(row[row.size() - 5]), intensity);
    if (std::isnan(heat))
      EXPECT_TRUE(std::isnan(stored));
    else
      EXPECT_EQ(stored, heat);
  };
  const std::string fields = ", ('channel_t', '|u1'), ('scalar_T', '<f4')]";
  ProcessResult result =
      run_voxdag({"trace", path("p.vdag"), "--rays", path("rays.npy"), "-o", path("out.npy")});
  ASSERT_EQ(result.status, 0) << result.err;
  auto found =
      rows("[('t', '<f4'), ('voxel', '<i4', (3,)), ('face', '|i1'), ('hit', '|b1')" + fields, 23);
  expect_values(found[0], 12, 2);  // The means of 10 and 13, of 1.5 and 2.5.
  expect_values(found[1], 0, NAN);

  NpyWriter points(path("points.npy"), "<f8", {3}, sizeof(double), 2);
  const double places[] = {1, 0, 0.25, 30, 30, 30};
  points.write_rows(places, 2);
  points.commit();
  result =
      run_voxdag({"query", path("p.vdag"), "--points", path("points.npy"), "-o", path("out.npy")});
  ASSERT_EQ(result.status, 0) << result.err;
  found = rows(
      "[('occupied', '|b1'), ('voxel', '<i4', (3,)), ('nearest', '<i4', (3,)), ('distance', "
      "'<f4'), ('t', '|u1'), ('scalar_T', '<f4')]",
      34);
  expect_values(found[0], 200, -4);
  expect_values(found[1], 7, 0.3f);

  NpyWriter segments(path("segments.npy"), "<f8", {6}, sizeof(double), 2);
  const double ends[] = {9, 0, 0, -9, 0, 0, 9, 9, 9, 9, 9, 10};
  segments.write_rows(ends, 2);
  segments.commit();
  result = run_voxdag(
      {"query", path("p.vdag"), "--segments", path("segments.npy"), "-o", path("out.npy")});
  ASSERT_EQ(result.status, 0) << result.err;
  found = rows("[('clear', '|b1'), ('t', '<f4'), ('voxel', '<i4', (3,))" + fields, 22);
  expect_values(found[0], 200, -4);
  expect_values(found[1], 0, NAN);
}

TEST_F(Channels, FieldsHaveDistinctNames) {
  ASSERT_EQ(import({"--channel", "intensity:as t", "--channel", "scalar_T:as channel_t"}).status,
            0);
  write_text(dir_ / "rays.npy", rays_npy({{-5, 0, 0, 0, 1, 0, 0, 100}}));
  ASSERT_EQ(run_voxdag({"trace", path("p.vdag"), "--rays", path("rays.npy"), "-o", path("out.npy")})
                .status,
            0);
  EXPECT_NE(read_text(path("out.npy")).find("('channel_channel_t', '|u1'), ('channel_t', '<f4')"),
            std::string::npos);
  ASSERT_EQ(import({"--channel", "intensity:as x", "--channel", "scalar_T:as channel_x"}).status,
            0);
  ASSERT_EQ(run_voxdag({"export", path("p.vdag"), "-o", path("out.ply")}).status, 0);
  EXPECT_NE(read_text(path("out.ply"))
                .find("property uchar channel_channel_x\nproperty float channel_x\n"),
            std::string::npos);
}

TEST_F(Channels, WhatIsWrongIsSaid) {
  expect_failure(import({"--channel", "heat"}), 1, "has no field 'heat'");
  expect_failure(import({"--channel", "intensity,bound=-1"}), 2, "--channel");
  expect_failure(import({"--channel", "intensity:as a b"}), 2, "--channel");
  expect_failure(import({"--channel", "scalar_T,kind=u8"}), 1,
                 "channel 'scalar_T': has the value -4, and the kind u8");
  write_text(dir_ / "p.csv", "0,0,0,1\n1,0,0,2\n");
  const auto import_of = [&](const std::string& file, const std::string& field) {
    return run_voxdag({"import", path(file), "--channel", field, "-o", path("n.vdag")});
  };
  expect_failure(import_of("p.csv", "a"), 1, "has no field 'a'; its fields are without names");
  EXPECT_EQ(import_of("p.csv", "4:as a").status, 0);
  const nlohmann::json list = channels("n.vdag");
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].at("name"), "a");
  EXPECT_EQ(list[0].at("greatest"), 2);
  write_text(dir_ / "b.binvox",
             "#binvox 1\ndim 2 2 2\ntranslate 0 0 0\nscale 1\ndata\n" + std::string("\x01\x08", 2));
  expect_failure(import_of("b.binvox", "value"), 1, "has a format of which no channels are read");
}

/// A box with a metal and a dull side.
class MaterialChannels : public Channels {
 protected:
  MaterialChannels() {
    write_text(dir_ / "a.mtl", "newmtl metal\nPm 1\nPr 0.2\nKd 1 0.8 0.4\nnewmtl dull\n");
    write_text(dir_ / "a.obj",
               "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\n"
               "v 0 1 1\nusemtl metal\nf 1 2 3 4\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\n"
               "usemtl dull\nf 2 3 7 6\nf 1 4 8 5\n");
  }
  ProcessResult build(const std::string& name, std::vector<std::string> more) const {
    std::vector<std::string> words{"build", path("a.obj"), "-r", "32", "-o", path(name)};
    words.insert(words.end(), more.begin(), more.end());
    return run_voxdag(words);
  }
  std::string picture(const std::string& name, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"render", path(name), "--size", "64x48", "-o", path("a.png")};
    words.insert(words.end(), more.begin(), more.end());
    const ProcessResult result = run_voxdag(words);
    EXPECT_EQ(result.status, 0) << result.err;
    return read_text(path("a.png"));
  }
};

TEST_F(MaterialChannels, BuildStoresThemAndVerifyComparesThemWithTheMesh) {
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, {"--color", "--compact"}, {"--solid"}}) {
    std::vector<std::string> options{"--channel", "metallic,roughness"};
    options.insert(options.end(), more.begin(), more.end());
    ASSERT_EQ(build("a.vdag", options).status, 0);
    const nlohmann::json list = channels("a.vdag");
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[0].at("name"), "metallic");
    EXPECT_EQ(list[0].at("kind"), "u8");
    EXPECT_EQ(list[0].at("least"), 0);
    EXPECT_EQ(list[0].at("greatest"), 255);
    EXPECT_EQ(list[1].at("name"), "roughness");
    EXPECT_EQ(list[1].at("least"), 51);
    EXPECT_EQ(list[1].at("greatest"), 255);
    const ProcessResult check = run_voxdag({"verify", path("a.vdag"), "--mesh", path("a.obj")});
    EXPECT_EQ(check.status, 0) << check.out;
    EXPECT_NE(check.out.find("channels        passed"), std::string::npos) << check.out;
  }
  write_text(dir_ / "a.mtl", "newmtl metal\nPm 0.5\nPr 0.2\nKd 1 0.8 0.4\nnewmtl dull\n");
  const ProcessResult check = run_voxdag({"verify", path("a.vdag"), "--mesh", path("a.obj")});
  EXPECT_EQ(check.status, 1) << check.out;
  EXPECT_NE(check.out.find("channels        FAILED"), std::string::npos) << check.out;
}

TEST_F(MaterialChannels, OneChannelMayBeStoredAlone) {
  ASSERT_EQ(build("a.vdag", {"--channel", "roughness"}).status, 0);
  const nlohmann::json list = channels("a.vdag");
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].at("name"), "roughness");
  write_text(dir_ / "a.mtl", "newmtl metal\nnewmtl dull\n");
  EXPECT_NE(
      build("a.vdag", {"--channel", "roughness"}).err.find("has no metallic and no roughness"),
      std::string::npos);
  expect_failure(build("b.vdag", {"--channel", "metallic,gloss"}), 2,
                 "\"gloss\" is neither metallic nor roughness");
  expect_failure(build("b.esvo", {"--channel", "metallic"}), 2, "is for DAGs only");
}

TEST_F(MaterialChannels, PicturesMirrorUnlessReflectionsAreOff) {
  ASSERT_EQ(build("a.vdag", {"--color", "--channel", "metallic,roughness"}).status, 0);
  ASSERT_EQ(build("b.vdag", {"--color"}).status, 0);
  const std::string mirrored = picture("a.vdag"), diffuse = picture("b.vdag");
  EXPECT_NE(mirrored, diffuse);
  EXPECT_EQ(picture("a.vdag", {"--no-reflections"}), diffuse);
  EXPECT_EQ(picture("b.vdag", {"--no-reflections"}), diffuse);
  EXPECT_EQ(picture("a.vdag", {"--color-by", "metallic"}),
            picture("a.vdag", {"--color-by", "metallic", "--no-reflections"}));
}

TEST_F(MaterialChannels, PostersOfAChannelDoNotMirror) {
  write_text(dir_ / "view.json", R"({"channel": {"name": "metallic"}})");
  const auto poster = [&](const std::string& channels) {
    EXPECT_EQ(build("a.vdag", {"--color", "--channel", channels}).status, 0);
    const ProcessResult result = run_voxdag(
        {"export", path("a.vdag"), "-o", path("a.html"), "--poster", "--view", path("view.json")});
    EXPECT_EQ(result.status, 0) << result.err;
    const std::string page = read_text(path("a.html"));
    const std::size_t begin = page.find("data:image/jpeg");
    EXPECT_NE(begin, std::string::npos);
    return page.substr(begin, page.find('"', begin) - begin);
  };
  // Mirrored light would differ, because it depends on the roughness.
  EXPECT_EQ(poster("metallic"), poster("metallic,roughness"));
}

}  // namespace
}  // namespace voxdag::cli
