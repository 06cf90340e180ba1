/// Tests the appearance that PLY files describe.
#include <gtest/gtest.h>

#include <cmath>

#include "formats/readers/appearance_files.hpp"
#include "formats/readers/mesh_text.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/image/color.hpp"

namespace voxdag {
namespace {

TEST_F(ReadAppearance, PlyColoursHaveTheNamesAndRangesOfOtherPrograms) {
  const auto ply = [&](const std::string& type, const std::array<std::string, 3>& names,
                       const std::string& color) {
    std::string text = "\xEF\xBB\xBFply\nformat ascii 1.0\nelement vertex 3\n";
    for (const char* axis : {"x", "y", "z"}) text += std::string("property float ") + axis + "\n";
    for (const std::string& name : names) text += "property " + type + " " + name + "\n";
    text += "element face 1\nproperty list uchar int vertex_index\nend_header\n";
    for (const char* point : {"0 0 0 ", "1 0 0 ", "0 1 0 "}) text += point + color + "\n";
    return read_mesh_with_appearance(write("a.ply", text + "3 0 1 2\n"));
  };
  const std::array<std::string, 3> rgb{"red", "green", "blue"};
  expect_near(ply("uchar", {"Red", "Green", "Blue"}, "255 0 0").appearance.colors[0].color(),
              {1, 0, 0});
  const auto to_255 = ply("ushort", rgb, "255 0 51");
  EXPECT_EQ(to_255.warnings.size(), 1u);
  expect_near(to_255.appearance.colors[0].color(), {1, 0, srgb_to_linear(0.2f)});
  const auto to_65535 = ply("ushort", rgb, "65535 0 255");
  EXPECT_TRUE(to_65535.warnings.empty());
  expect_near(to_65535.appearance.colors[0].color(), {1, 0, srgb_to_linear(255.0f / 65535)});
  const auto splats = ply("float", {"f_dc_0", "f_dc_1", "f_dc_2"}, "1.7724539 -1.7724539 0");
  EXPECT_TRUE(splats.warnings.empty());
  expect_near(splats.appearance.colors[0].color(), {1, 0, srgb_to_linear(0.5f)});
}

TEST_F(ReadAppearance, PlyFacesMayNumberTheirTextures) {
  const auto result = read_mesh_with_appearance(write(
      "a.ply",
      "ply\nformat ascii 1.0\ncomment TextureFile a.png\ncomment TextureFile b.png\n"
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
      "property list uchar int vertex_indices\nproperty list uchar float texcoord\n"
      "property int texnumber\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 0 0 1 0 0 1 0\n"
      "3 0 1 2 6 0 0 1 0 0 1 1\n3 0 1 2 6 0 0 1 0 0 1 -1\n3 0 1 2 6 0 0 1 0 0 1 2\n"));
  EXPECT_EQ(result.mesh.triangle_materials, (StoredVector<std::uint32_t>{0, 1, 2, 2}));
  EXPECT_EQ(result.mesh.materials, (std::vector<std::string>{"a.png", "b.png", ""}));
  const Appearance& a = result.appearance;
  ASSERT_EQ(a.materials.size(), 3u);
  EXPECT_EQ(a.images[1].path, directory_.path() / "b.png");
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(a.materials[static_cast<std::size_t>(i)].color_map.image, i == 2 ? -1 : i);
  EXPECT_EQ(
      result.warnings,
      std::vector{path("a.ply") + ": 1 face with the number of a texture that does not exist: "
                                  "without a texture"});
}

const std::string kPlyEnd = "element face 1\nproperty list uchar int vertex_index\nend_header\n";

TEST_F(ReadAppearance, PlyVerticesInText) {
  const auto result = read(
      "a.ply",
      "ply\nformat ascii 1.0\ncomment TextureFile skin.png\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nproperty float nx\nproperty float ny\n"
      "property float nz\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property float s\nproperty float t\n" +
          kPlyEnd +
          "0 0 0  0 0 2  255 128 0  0 0\n1 0 0  0 1 0  0 0 0  1 0\n0 1 0  0 0 0  9 9 9  0 1\n"
          "3 2 0 1\n");
  const Appearance& a = result.appearance;
  EXPECT_EQ(a.normals, (std::vector<Vec3f>{{}, {0, 0, 1}, {0, 1, 0}}));
  EXPECT_EQ(a.uvs, (std::vector<Vec2f>{{0, 0}, {0, 1}, {1, 1}}));
  ASSERT_EQ(a.colors.size(), 3u);
  expect_near(a.colors[1].color(), {1, srgb_to_linear(128.0f / 255), 0});
  EXPECT_EQ(a.materials[0].color_map.image, 0);
  EXPECT_EQ(a.images[0].path, directory_.path() / "skin.png");
}

TEST_F(ReadAppearance, PlyVerticesInBothBinaryOrders) {
  for (const bool big : {false, true}) {
    std::string bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                        "_endian 1.0\nelement vertex 3\nproperty list uchar short extra\n"
                        "property float x\nproperty float y\nproperty float z\n"
                        "property double u\nproperty double v\nproperty ushort red\n"
                        "property ushort green\nproperty ushort blue\nproperty ushort alpha\n" +
                        kPlyEnd;
    for (int i = 0; i < 3; ++i) {
      append(bytes, static_cast<std::uint8_t>(i));
      for (int n = 0; n < i; ++n) append<std::int16_t>(bytes, 7, big);
      append(bytes, i == 1 ? 1.0f : 0.0f, big);
      append(bytes, i == 2 ? 1.0f : 0.0f, big);
      append(bytes, 0.0f, big);
      append(bytes, 0.25 * i, big);
      append(bytes, 1.0, big);
      for (const int c : {65535, 0, 0, 65535 - i})
        append(bytes, static_cast<std::uint16_t>(c), big);
    }
    append<std::uint8_t>(bytes, 3);
    for (const int i : {0, 1, 2}) append<std::int32_t>(bytes, i, big);
    const auto result = read("a.ply", bytes);
    EXPECT_EQ(result.appearance.uvs, (std::vector<Vec2f>{{0, 0}, {0.25f, 0}, {0.5f, 0}}));
    EXPECT_EQ(result.appearance.colors[2], (Rgba16{65535, 0, 0, 65533}));
  }
}

TEST_F(ReadAppearance, PlyFacesMayHaveColoursAndCoordinates) {
  const auto result =
      read("a.ply",
           "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
           "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
           "property list uchar float texcoord\nproperty uchar red\nproperty uchar green\n"
           "property uchar blue\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 0 0 1 0 0 1 255 0 0\n");
  EXPECT_EQ(result.appearance.uvs, (std::vector<Vec2f>{{0, 1}, {1, 1}, {0, 0}}));
  EXPECT_EQ(result.appearance.colors, (std::vector<Rgba16>(3, {65535, 0, 0, 65535})));
}

TEST_F(ReadAppearance, PlyPolygonsKeepTheirCoordinatesHoweverTheyAreCut) {
  // An arrow head, whose fan would not stay inside it, starting at each of its corners. Corner i
  // has (i / 10, 0).
  for (int first = 0; first < 4; ++first) {
    std::string corners, uvs;
    for (int i = 0; i < 4; ++i) {
      const std::string corner = std::to_string((first + i) % 4);
      corners += " " + corner;
      uvs += " 0." + corner + " 0";
    }
    const auto result =
        read("a.ply",
             "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
             "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
             "property list uchar float texcoord\nend_header\n"
             "0 0 0\n2 1 0\n0 2 0\n0.5 1 0\n4" +
                 corners + " 8" + uvs + "\n");
    ASSERT_EQ(result.appearance.uvs.size(), 6u);
    for (std::size_t c = 0; c < 6; ++c)
      EXPECT_FLOAT_EQ(result.appearance.uvs[c].x,
                      static_cast<float>(result.mesh.triangles[c / 3][c % 3]) / 10);
  }
}

TEST_F(ReadAppearance, PlyAlphaThatWouldHideAllIsIgnored) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property uchar alpha\n" +
      kPlyEnd;
  const auto hidden =
      read("a.ply", text + "0 0 0 1 1 1 0\n1 0 0 1 1 1 0\n0 1 0 1 1 1 0\n3 0 1 2\n");
  EXPECT_EQ(hidden.appearance.materials[0].alpha_mode, AlphaMode::kOpaque);
  const auto shown =
      read("a.ply", text + "0 0 0 1 1 1 0\n1 0 0 1 1 1 200\n0 1 0 1 1 1 0\n3 0 1 2\n");
  EXPECT_EQ(shown.appearance.materials[0].alpha_mode, AlphaMode::kBlend);
}

}  // namespace
}  // namespace voxdag
