/// Tests the appearance that glTF files describe.
#include <gtest/gtest.h>

#include <cmath>

#include "formats/readers/appearance_files.hpp"
#include "formats/readers/mesh_text.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/image/color.hpp"

namespace voxdag {
namespace {

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

TEST_F(ReadAppearance, GltfMetallicAndRoughnessAreFactorsAndATexture) {
  const auto result = read("a.gltf", gltf(R"("materials":[{"pbrMetallicRoughness":{
             "metallicFactor":0.25,"roughnessFactor":0.5,"metallicRoughnessTexture":{"index":1,
             "texCoord":1,"extensions":{"KHR_texture_transform":{"offset":[0.5,0.25]}}}}},{},
             {"pbrMetallicRoughness":{"metallicFactor":7,"roughnessFactor":-1}},
             {"extensions":{"KHR_materials_pbrSpecularGlossiness":{}}}],
             "textures":[{"source":0},{"source":1,"sampler":0}],"samplers":[{"wrapS":33071}],
             "images":[{"uri":"c.png"},{"uri":"mr.png"}])"));
  const std::vector<Material>& m = result.appearance.materials;
  EXPECT_EQ(m[0].metallic_roughness, (MetallicRoughness{0.25f, 0.5f}));
  EXPECT_EQ(m[0].map_factors, (MetallicRoughness{0.25f, 0.5f}));
  EXPECT_EQ(m[0].metallic_map.image, 1);
  EXPECT_EQ(m[0].metallic_map.wrap_u, TextureWrap::kClamp);
  EXPECT_EQ(m[0].metallic_map.uv({0, 0}), (Vec2f{0.5f, 0.25f}));
  EXPECT_EQ(m[0].roughness_map, m[0].metallic_map);
  EXPECT_EQ(result.appearance.uvs[0], (Vec2f{0, 1}));  // TEXCOORD_1
  EXPECT_EQ(m[1].metallic_roughness, (MetallicRoughness{1, 1}));
  EXPECT_FALSE(m[1].metallic_map.exists());
  EXPECT_EQ(m[2].metallic_roughness, (MetallicRoughness{1, 0}));
  EXPECT_EQ(m[3].metallic_roughness, (MetallicRoughness{0, 1}));
}

TEST_F(ReadAppearance, AGltfMetallicRoughnessTextureThatIsMalformedIsReplacedByItsFactors) {
  for (const auto& [texture, fault] :
       {std::pair{R"({"index":7})", "textures[7] does not exist"},
        std::pair{R"({"index":0,"texCoord":1})",
                  "uses other texture coordinates than the colour texture"}}) {
    const auto result = read_mesh_with_appearance(
        write("a.gltf", gltf(R"("materials":[{"pbrMetallicRoughness":{"metallicFactor":0.5,
             "baseColorTexture":{"index":0},"metallicRoughnessTexture":)" +
                             std::string(texture) +
                             R"(}}],"textures":[{"source":0}],"images":[{"uri":"c.png"}])")));
    ASSERT_EQ(result.warnings.size(), 1u);
    EXPECT_EQ(result.warnings[0],
              path("a.gltf") +
                  ": materials[0].pbrMetallicRoughness.metallicRoughnessTexture: " + fault +
                  ": the material's metallicFactor and roughnessFactor replace the texture");
    EXPECT_EQ(result.appearance.materials[0].metallic_roughness, (MetallicRoughness{0.5f, 1}));
    EXPECT_FALSE(result.appearance.materials[0].metallic_map.exists());
  }
}

TEST_F(ReadAppearance, AGltfFactorThatIsNoNumberMakesTheMaterialDullAndKeepsTheRest) {
  const auto result = read_mesh_with_appearance(
      write("a.gltf", gltf(R"("materials":[{"pbrMetallicRoughness":{"roughnessFactor":"x"},
             "emissiveFactor":[1,1,0]}])")));
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_NE(result.warnings[0].find("roughnessFactor"), std::string::npos) << result.warnings[0];
  EXPECT_NE(result.warnings[0].find("the material is dull"), std::string::npos);
  EXPECT_EQ(result.appearance.materials[0].metallic_roughness, (MetallicRoughness{0, 1}));
  EXPECT_EQ(result.appearance.materials[0].emission, (Vec3f{1, 1, 0}));
}

}  // namespace
}  // namespace voxdag
