/// Tests the appearance that mesh files describe.
#include "voxdag/mesh/appearance.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "formats/readers/appearance_files.hpp"
#include "formats/readers/mesh_text.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/image/color.hpp"

namespace voxdag {
namespace {

TEST_F(ReadAppearance, ObjCornersHaveTheirCoordinatesAndNormals) {
  const auto result = read("a.obj", kSquare +
                                        "vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 2\nvn 3 0 0\n"
                                        "f 1/1/1 2/2/2 3/3/1\nf -4//-1 -2/-1 -1\n");
  const Appearance& a = result.appearance;
  // In the file v points up, in the library down.
  EXPECT_EQ(a.uvs, (std::vector<Vec2f>{{0, 1}, {1, 1}, {1, 0}, {}, {1, 0}, {}}));
  EXPECT_EQ(a.normals, (std::vector<Vec3f>{{0, 0, 1}, {1, 0, 0}, {0, 0, 1}, {1, 0, 0}, {}, {}}));
  EXPECT_TRUE(a.colors.empty());
  ASSERT_EQ(a.materials.size(), 1u);
  EXPECT_EQ(Appearance::material_index(result.mesh, 1), 0u);
}

TEST_F(ReadAppearance, ObjPolygonsKeepTheirCornersHoweverTheyAreCut) {
  // An arrow head, whose fan would not stay inside it. vt number i is (i / 10, 0).
  std::string text = "v 0 0 0\nv 2 1 0\nv 0 2 0\nv 0.5 1 0\n";
  for (int i = 1; i <= 4; ++i) text += "vt 0." + std::to_string(i) + " 0\n";
  for (const char* face : {"f 1/1 2/2 3/3 4/4\n", "f 2/2 3/3 4/4 1/1\n", "f 3/3 4/4 1/1 2/2\n"}) {
    const auto result = read("a.obj", text + face);
    ASSERT_EQ(result.mesh.triangles.size(), 2u);
    for (std::size_t c = 0; c < 6; ++c)
      EXPECT_FLOAT_EQ(result.appearance.uvs[c].x,
                      static_cast<float>(result.mesh.triangles[c / 3][c % 3] + 1) / 10);
  }
}

TEST_F(ReadAppearance, ObjFilesOfManyChunksKeepTheirPlaces) {
  std::string text;
  constexpr int kCount = 60'000;
  for (int i = 0; i < kCount; ++i) {
    const std::string n = std::to_string(i);
    text += "v " + n + " 0 0\nv " + n + " 1 0\nv " + n + " 0 1\nvt 0." + n + " 0.5\n";
    text += i % 2 == 0
                ? "f -3/-1 -2/-1 -1/-1\n"
                : "f " + std::to_string(3 * i + 1) + "/" + std::to_string(i + 1) + " -2 -1\n";
  }
  const auto result = read("a.obj", text);
  ASSERT_EQ(result.appearance.uvs.size(), 3u * kCount);
  for (int i = 0; i < kCount; ++i)
    EXPECT_EQ(result.appearance.uvs[static_cast<std::size_t>(3 * i)],
              (Vec2f{std::stof("0." + std::to_string(i)), 0.5f}));
}

TEST_F(ReadAppearance, ObjVerticesMayHaveColours) {
  const auto result = read("a.obj", "v 0 0 0 1 0.5 0\nv 1 0 0 0 0 0\nv 0 1 0 1 1 1\nf 1 2 3\n");
  ASSERT_EQ(result.appearance.colors.size(), 3u);
  expect_near(result.appearance.colors[0].color(), {1, srgb_to_linear(0.5f), 0});
  EXPECT_EQ(result.appearance.colors[2], Rgba16{});
  EXPECT_EQ(result.appearance.materials[0].base_color, (Vec3f{1, 1, 1}));
}

TEST_F(ReadAppearance, ObjVerticesWithoutColoursKeepThatOfTheirMaterial) {
  write("a.mtl", "newmtl red\nKd 1 0 0\nnewmtl both\nKd 0 1 0\n");
  const auto result = read("a.obj", "mtllib a.mtl\n" + kSquare +
                                        "v 0 0 1 0 0 1\nv 1 0 1 0 0 1\nv 0 1 1 0 0 1\nusemtl red\n"
                                        "f 1 2 3\nusemtl both\nf 5 6 7\nf 1 2 5\n");
  const Appearance& a = result.appearance;
  EXPECT_EQ(a.materials[0].base_color, (Vec3f{1, 0, 0}));
  EXPECT_EQ(a.materials[1].base_color, (Vec3f{1, 1, 1}));
  const Rgba16 blue{0, 0, 65535, 65535}, green{0, 65535, 0, 65535};
  EXPECT_EQ(a.colors, (std::vector<Rgba16>{{}, {}, {}, blue, blue, blue, green, green, blue}));
}

TEST_F(ReadAppearance, ColoursMayBeNumbersUpTo255) {
  const auto obj = read_mesh_with_appearance(
      write("a.obj", "v 0 0 0 255 127.5 0\nv 1 0 0 1 0 0\nv 0 1 0 255 255 255\nf 1 2 3\n"));
  const auto ply = read_mesh_with_appearance(
      write("a.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
            "property float z\nproperty float red\nproperty double green\n"
            "property float blue\nelement face 1\nproperty list uchar int vertex_index\n"
            "end_header\n0 0 0 255 127.5 0\n1 0 0 1 0 0\n0 1 0 255 255 255\n3 0 1 2\n"));
  for (const auto& read : {obj, ply}) {
    EXPECT_EQ(read.warnings.size(), 1u);
    expect_near(read.appearance.colors[0].color(), {1, srgb_to_linear(0.5f), 0});
    expect_near(read.appearance.colors[1].color(), {srgb_to_linear(1.0f / 255), 0, 0});
    EXPECT_EQ(read.appearance.colors[2], Rgba16{});
  }
}

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

TEST_F(ReadAppearance, ReferencesToNothingAreAWarning) {
  const auto result =
      read_mesh_with_appearance(write("a.obj", kSquare + "vt 1 1\nf 1/1 2/2 3/-7\n"));
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_NE(result.warnings[0].find("2 corners of faces name"), std::string::npos);
  EXPECT_EQ(result.appearance.uvs, (std::vector<Vec2f>{{1, 0}, {}, {}}));
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

/// Returns a triangle with all attributes. `extra` is added to the asset, `node` to its node.
std::string gltf(const std::string& extra, const std::string& node = "") {
  std::string bytes;
  for (const float f : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f})
    append(bytes, f);  // positions
  for (const float f : {0.f, 0.f, 1.f, 0.f, 1.f, 0.f, 1.f, 0.f, 0.f}) append(bytes, f);  // normals
  for (const float f : {0.f, 0.f, 1.f, 0.f, 0.f, 1.f}) append(bytes, f);  // TEXCOORD_0
  for (const int i : {0, 65535, 65535, 0, 32768, 0})                      // TEXCOORD_1
    append(bytes, static_cast<std::uint16_t>(i));
  for (const int i : {255, 0, 0, 128, 0, 255, 0, 255, 0, 0, 255, 255})  // COLOR_0
    append(bytes, static_cast<std::uint8_t>(i));
  std::string hex;
  for (const char c : bytes) {
    const char* digits = "0123456789abcdef";
    const auto byte = static_cast<unsigned char>(c);
    hex += {'%', digits[byte >> 4], digits[byte & 15]};
  }
  return R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0)" + node +
         R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2,)"
         R"("TEXCOORD_1":3,"COLOR_0":4},"material":0}]}],"accessors":[)"
         R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
         R"({"bufferView":0,"byteOffset":36,"componentType":5126,"count":3,"type":"VEC3"},)"
         R"({"bufferView":0,"byteOffset":72,"componentType":5126,"count":3,"type":"VEC2"},)"
         R"({"bufferView":0,"byteOffset":96,"componentType":5123,"normalized":true,"count":3,)"
         R"("type":"VEC2"},)"
         R"({"bufferView":0,"byteOffset":108,"componentType":5121,"normalized":true,"count":3,)"
         R"("type":"VEC4"}],"bufferViews":[{"buffer":0,"byteLength":120}],)"
         R"("buffers":[{"byteLength":120,"uri":"data:application/octet-stream,)" +
         hex + R"("}],)" + extra + "}";
}

TEST_F(ReadAppearance, GltfCornersAndMaterial) {
  const auto result = read(
      "a.gltf",
      gltf(R"("materials":[{"name":"m","pbrMetallicRoughness":{"baseColorFactor":[0.5,1,0.25,0.75],
             "baseColorTexture":{"index":0}},"alphaMode":"MASK","alphaCutoff":0.3,
             "normalTexture":{"index":1,"scale":0.5}}],
             "textures":[{"source":1,"sampler":0},{"source":0}],
             "samplers":[{"wrapS":33071,"wrapT":33648}],
             "images":[{"uri":"n%20n.png"},{"uri":"data:image/png;base64,AAEC"}])"));
  const Appearance& a = result.appearance;
  EXPECT_EQ(a.normals, (std::vector<Vec3f>{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}));
  EXPECT_EQ(a.uvs, (std::vector<Vec2f>{{0, 0}, {1, 0}, {0, 1}}));
  ASSERT_EQ(a.colors.size(), 3u);
  expect_near(a.colors[0].color(), {1, 0, 0});
  EXPECT_NEAR(a.colors[0].alpha(), 128.0f / 255, 1e-4f);  // linear light
  ASSERT_EQ(a.materials.size(), 1u);
  const Material& m = a.materials[0];
  EXPECT_EQ(m.name, "m");
  EXPECT_EQ(m.texture_tint, (Vec3f{0.5f, 1, 0.25f}));
  EXPECT_FLOAT_EQ(m.alpha, 0.75f);
  EXPECT_EQ(m.alpha_mode, AlphaMode::kMask);
  EXPECT_FLOAT_EQ(m.alpha_cutoff, 0.3f);
  EXPECT_EQ(m.color_map.image, 1);
  EXPECT_EQ(m.color_map.wrap_u, TextureWrap::kClamp);
  EXPECT_EQ(m.color_map.wrap_v, TextureWrap::kMirror);
  EXPECT_EQ(m.normal_map.image, 0);
  EXPECT_FLOAT_EQ(m.normal_scale, 0.5f);
  EXPECT_EQ(a.images[0].path, directory_.path() / "n n.png");
  EXPECT_EQ(a.images[1].bytes, (std::vector<std::uint8_t>{0, 1, 2}));
}

TEST_F(ReadAppearance, GltfTexturesChooseTheirCoordinates) {
  const auto result =
      read("a.gltf", gltf(R"("materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0,
             "texCoord":1,"extensions":{"KHR_texture_transform":{"offset":[0.5,0.25],
             "rotation":1.5707963267948966,"scale":[2,3]}}}}}],"textures":[{"source":0}],
             "images":[{"bufferView":0,"mimeType":"image/png"}])"));
  EXPECT_EQ(result.appearance.uvs[0], (Vec2f{0, 1}));
  EXPECT_NEAR(result.appearance.uvs[2].x, 0.5f, 1e-4f);
  EXPECT_EQ(result.appearance.images[0].bytes.size(), 120u);
  // Scaled to (0.2, 0.6), rotated counter-clockwise as seen in the image (v points down), moved.
  const Vec2f uv = result.appearance.materials[0].color_map.uv({0.1f, 0.2f});
  EXPECT_NEAR(uv.x, 0.6f + 0.5f, 1e-5f);
  EXPECT_NEAR(uv.y, -0.2f + 0.25f, 1e-5f);
}

TEST_F(ReadAppearance, GltfNormalsTurnWithTheirNodes) {
  // Scaled by a half along x and mirrored along y: normals tilt in the opposite direction to the
  // surface.
  const auto result = read("a.gltf", gltf(R"("materials":[{}])", R"(,"scale":[0.5,-1,1])"));
  EXPECT_EQ(result.appearance.normals, (std::vector<Vec3f>{{0, 0, 1}, {1, 0, 0}, {0, -1, 0}}));
  EXPECT_EQ(result.mesh.triangles[0], (Triangle{0, 2, 1}));
  EXPECT_EQ(result.mesh.vertices[1], (Vec3f{0.5f, 0, 0}));
}

TEST_F(ReadAppearance, GltfMaterialsOfExtensionsAndTheirLight) {
  const auto result = read("a.gltf", gltf(R"("materials":[{"emissiveFactor":[0.5,0,0.25],
             "emissiveTexture":{"index":0},"extensions":{
             "KHR_materials_pbrSpecularGlossiness":{"diffuseFactor":[0.5,1,0.25,0.75],
             "diffuseTexture":{"index":1}},
             "KHR_materials_emissive_strength":{"emissiveStrength":4}}}],
             "textures":[{"source":0},{"source":9,"extensions":{"EXT_texture_webp":{"source":1}}}],
             "images":[{"uri":"e.png"},{"uri":"w.webp"}])"));
  const Material& m = result.appearance.materials[0];
  EXPECT_EQ(m.base_color, (Vec3f{0.5f, 1, 0.25f}));
  EXPECT_FLOAT_EQ(m.alpha, 0.75f);
  EXPECT_EQ(m.color_map.image, 1);
  EXPECT_EQ(m.emission, (Vec3f{2, 0, 1}));
  EXPECT_EQ(m.emission_map.image, 0);
}

TEST_F(ReadAppearance, GltfPartsThatAreMalformedAreLeftOut) {
  const auto result = read_mesh_with_appearance(
      write("a.gltf", gltf(R"("materials":[{"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1],
             "baseColorTexture":{"index":7}}}],"textures":{})")));
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_EQ(result.warnings[0],
            path("a.gltf") +
                ": materials[0].pbrMetallicRoughness.baseColorTexture: textures[7] does not exist: "
                "the material's colour replaces the texture");
  EXPECT_EQ(result.appearance.materials[0].base_color, (Vec3f{1, 0, 0}));
}

TEST_F(ReadAppearance, FormatsWithoutAppearanceAreGrey) {
  const auto result = read("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_TRUE(result.appearance.normals.empty());
  ASSERT_EQ(result.appearance.materials.size(), 1u);
  expect_near(result.appearance.materials[0].base_color,
              {srgb_to_linear(0.8f), srgb_to_linear(0.8f), srgb_to_linear(0.8f)});
}

TEST_F(ReadAppearance, TheMeshEqualsTheOneOfReadMesh) {
  const char* scenes = std::getenv("VOXDAG_SCENES");
  if (scenes == nullptr) GTEST_SKIP() << "VOXDAG_SCENES is not set";
  for (const char* name :
       {"crytek_sponza/sponza.obj", "sibenik/sibenik.obj", "game_maps/zdm2.obj",
        "flight_helmet/FlightHelmet.gltf", "kitchen/kitchen.ply", "recast/dungeon.obj"}) {
    const auto file = std::filesystem::path(scenes) / name;
    if (!std::filesystem::exists(file)) continue;
    const MeshWithAppearance result = read_mesh_with_appearance(file);
    EXPECT_TRUE(result.mesh == read_mesh(file)) << name;
    const Appearance& a = result.appearance;
    const std::size_t corners = 3 * result.mesh.triangles.size();
    EXPECT_TRUE(a.normals.empty() || a.normals.size() == corners);
    EXPECT_TRUE(a.uvs.empty() || a.uvs.size() == corners);
    EXPECT_EQ(a.materials.size(), std::max<std::size_t>(result.mesh.materials.size(), 1));
    // Normals agree with the triangles nearly everywhere.
    std::size_t against = 0;
    for (std::size_t c = 0; c < a.normals.size(); ++c) {
      const Triangle& t = result.mesh.triangles[c / 3];
      const Vec3f p = result.mesh.vertices[t[0]];
      const Vec3f n = cross(result.mesh.vertices[t[1]] - p, result.mesh.vertices[t[2]] - p);
      against += dot(n, a.normals[c]) < 0;
    }
    EXPECT_LE(against, corners / 50) << name;
  }
}

/// Makes a folder the current folder while the object lives.
class CurrentFolder {
 public:
  explicit CurrentFolder(const std::filesystem::path& folder) {
    std::filesystem::current_path(folder);
  }
  ~CurrentFolder() { std::filesystem::current_path(before_); }

 private:
  std::filesystem::path before_ = std::filesystem::current_path();
};

TEST_F(ReadAppearance, AMissingTextureOfAMeshInTheCurrentFolderIsAWarning) {
  write("a.obj", "mtllib m.mtl\n" + kSquare + "vt 0 0\nusemtl m\nf 1/1 2/1 3/1\n");
  write("m.mtl", "newmtl m\nmap_Kd missing.png\n");
  const CurrentFolder folder(directory_.path());
  const MeshWithAppearance result = read_mesh_with_appearance("a.obj");
  ASSERT_EQ(result.appearance.images.size(), 1u);
  EXPECT_EQ(result.appearance.images[0].path, "missing.png");
}

}  // namespace
}  // namespace voxdag
