#include "voxdag/formats/readers/gltf/gltf_reader.hpp"

#include <cmath>

#include "gltf_asset.hpp"

namespace voxdag {
namespace {

using namespace gltf_test;

TEST(GltfReader, IndexedTrianglesFromJsonAndBinary) {
  for (const std::string& bytes : {square().text(), square().glb()}) {
    const Mesh mesh = read_text(read_gltf, bytes);
    EXPECT_EQ(mesh.vertices, kSquareVertices);
    EXPECT_EQ(mesh.triangles, (StoredVector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_TRUE(mesh.materials.empty());
  }
}

TEST(GltfReader, EveryIndexTypeAndEveryTriangleMode) {
  Asset asset;
  asset.accessor(asset.view(kSquarePoints), 5126, 4, "VEC3");
  asset.accessor(asset.view<std::uint8_t>({0, 1, 2, 3}), 5121, 4, "SCALAR");
  asset.accessor(asset.view<std::uint16_t>({3, 2, 1, 0}), 5123, 4, "SCALAR");
  asset.accessor(asset.view<std::uint32_t>({1, 2, 3}), 5125, 3, "SCALAR");
  const auto add = [&](int mode, int indices) {
    Json primitive = {{"attributes", {{"POSITION", 0}}}, {"mode", mode}};
    if (indices > 0) primitive["indices"] = indices;
    asset.primitive(primitive);
  };
  add(5, 1);
  add(6, 2);
  add(4, 3);
  add(4, 0);  // 4 vertices: the last one is ignored
  add(5, 0);
  add(0, 1);  // points and lines are ignored
  add(3, 1);
  const Mesh mesh = read_text(read_gltf, asset.text());
  EXPECT_EQ(mesh.vertices, kSquareVertices);  // shared by all primitives of the mesh
  EXPECT_EQ(
      mesh.triangles,
      (StoredVector<Triangle>{
          {0, 1, 2}, {1, 3, 2}, {2, 1, 3}, {1, 0, 3}, {1, 2, 3}, {0, 1, 2}, {0, 1, 2}, {1, 3, 2}}));
}

TEST(GltfReader, NodesTransformAndInstance) {
  Asset asset = square();
  asset.json["nodes"] = {
      {{"children", {1, 2}}, {"translation", {10, 0, 0}}, {"scale", {2, 2, 2}}},
      {{"mesh", 0}, {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}},  // 90 degrees about z
      {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 5, 1}}}};
  const Mesh mesh = read_text(read_gltf, asset.text());
  ASSERT_EQ(mesh.vertices.size(), 8u);
  ASSERT_EQ(mesh.triangles.size(), 4u);
  const auto near = [](Vec3f a, Vec3f b) {  // cos(90 degrees) is not exactly zero
    return std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.z - b.z) < 1e-5f;
  };
  EXPECT_TRUE(near(mesh.vertices[1], {10, 2, 0}));
  EXPECT_TRUE(near(mesh.vertices[2], {8, 2, 0}));
  EXPECT_EQ(mesh.vertices[4 + 2], (Vec3f{12, 0, 12}));
  EXPECT_EQ(mesh.triangles[3], (Triangle{4, 6, 7}));
}

TEST(GltfReader, NodesAreTheObjectsOnRequest) {
  Asset asset = square();
  asset.json["scenes"][0]["nodes"] = {0, 1, 2};
  asset.json["nodes"] = {{{"mesh", 0}, {"name", "chair"}}, {{"name", "empty"}}, {{"mesh", 0}}};
  const std::string text = asset.text();
  MeshSource source{text, "mesh", {}, nullptr, {}};
  EXPECT_TRUE(read_gltf(source, ReadParts::kMesh).mesh.objects.empty());
  source.options.objects = true;
  const Mesh mesh = read_gltf(source, ReadParts::kMesh).mesh;
  EXPECT_EQ(mesh.objects, (std::vector<std::string>{"chair", "node 2"}));
  EXPECT_EQ(mesh.object_runs, (std::vector<ObjectRun>{{0, 0}, {2, 1}}));
}

TEST(GltfReader, WithoutScenesAllRootNodesShow) {
  Asset asset = square();
  asset.json.erase("scene");
  asset.json.erase("scenes");
  asset.json["nodes"] = {{{"mesh", 0}}, {{"children", {0}}}, {{"mesh", 0}}};
  EXPECT_EQ(read_text(read_gltf, asset.text()).triangles.size(), 4u);
  asset.json.erase("nodes");
  EXPECT_EQ(read_text(read_gltf, asset.text()).triangles.size(), 2u);
}

TEST(GltfReader, SparseValuesReplaceDenseOnesOrZeros) {
  Asset asset = square();
  const auto indices = asset.view<std::uint8_t>({1, 3});
  const auto values = asset.view<float>({7, 8, 9, 4, 5, 6});
  asset.json["accessors"][0]["sparse"] = {
      {"count", 2},
      {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
      {"values", {{"bufferView", values}}}};
  EXPECT_EQ(read_text(read_gltf, asset.text()).vertices,
            (StoredVector<Vec3f>{{0, 0, 0}, {7, 8, 9}, {1, 1, 0}, {4, 5, 6}}));
  asset.json["accessors"][0].erase("bufferView");
  EXPECT_EQ(read_text(read_gltf, asset.text()).vertices,
            (StoredVector<Vec3f>{{0, 0, 0}, {7, 8, 9}, {0, 0, 0}, {4, 5, 6}}));
  asset.json["accessors"][0]["count"] = 3'000'000'000u;
  EXPECT_EQ(
      refusal(read_gltf, asset.text()),
      "mesh: accessors[0]: 3000000000 elements without a buffer view: at most 16777216 are read");
}

TEST(GltfReader, StridedAndQuantisedPositions) {
  Asset asset;
  asset.json["extensionsUsed"] = {"KHR_mesh_quantization"};
  asset.accessor(asset.view<std::int16_t>({0, 0, 0, 9, 32767, -32768, 100, 9, 0, 1, 0, 9}, 8), 5122,
                 3, "VEC3");
  asset.primitive({{"attributes", {{"POSITION", 0}}}});
  EXPECT_EQ(read_text(read_gltf, asset.text()).vertices[1], (Vec3f{32767, -32768, 100}));
  asset.json["accessors"][0]["normalized"] = true;
  EXPECT_EQ(read_text(read_gltf, asset.text()).vertices[1],
            (Vec3f{1, -1, static_cast<float>(100.0 / 32767)}));
  asset.json.erase("extensionsUsed");
  asset.primitive({{"attributes", {{"POSITION", 0}}}});
  const MeshWithAppearance undeclared = read_all(asset.text());
  EXPECT_EQ(undeclared.mesh.vertices[1], (Vec3f{1, -1, static_cast<float>(100.0 / 32767)}));
  EXPECT_EQ(undeclared.warnings,
            std::vector{std::string("mesh: accessors[0]: positions are integers, which "
                                    "KHR_mesh_quantization allows, but the file does not declare "
                                    "it: they are read")});
  asset.json["accessors"][0]["componentType"] = 5125;
  EXPECT_EQ(refusal(read_gltf, asset.text()),
            "mesh: accessors[0]: positions must have component type 5126 (float), not 5125");
}

TEST(GltfReader, MaterialsAreKeptAndTheDefaultOneIsUnnamed) {
  Asset asset = square();
  asset.json["materials"] = {{{"name", "Brass"}}, {{"name", "Glass"}}};
  asset.json["meshes"][0]["primitives"][0]["material"] = 1;
  asset.primitive({{"attributes", {{"POSITION", 0}}}, {"indices", 1}});
  const Mesh mesh = read_text(read_gltf, asset.text());
  EXPECT_EQ(mesh.materials, (std::vector<std::string>{"Brass", "Glass", ""}));
  EXPECT_EQ(mesh.triangle_materials, (StoredVector<std::uint32_t>{1, 1, 2, 2}));
}

TEST(GltfReader, RefusalsNameTheValueAndTheReason) {
  const auto refused = [](auto change) {
    Asset asset = square();
    change(asset.json);
    return refusal(read_gltf, asset.text());
  };
  EXPECT_EQ(refusal(read_gltf, ""), "mesh: the file is empty");
  EXPECT_EQ(refusal(read_gltf, "{\"asset\": }"),
            "mesh: byte 10: not glTF: the JSON is malformed here");
  EXPECT_EQ(refusal(read_gltf, "[]"), "mesh: not glTF: the JSON is not an object");
  EXPECT_EQ(refusal(read_gltf, "{\"a\": 1e999}"),
            "mesh: byte 6: not glTF: the JSON has a number out of range");
  EXPECT_EQ(refused([](Json& j) { j["asset"]["version"] = "1.0"; }),
            "mesh: glTF version '1.0': only version 2 is read");
  EXPECT_EQ(refused([](Json& j) { j["extensionsRequired"] = {"KHR_materials_unheard_of"}; }),
            "mesh: extensionsRequired[0]: extension 'KHR_materials_unheard_of' is not supported");
  EXPECT_EQ(refused([](Json& j) { j["accessors"][0]["count"] = 5; }),
            "mesh: accessors[0]: accessor of 5 elements goes beyond its buffer view");
  EXPECT_EQ(refused([](Json& j) { j["accessors"][1]["count"] = -1; }),
            "mesh: accessors[1].count: is not a whole number of 0 or more");
  EXPECT_EQ(refused([](Json& j) { j["accessors"][0]["byteOffset"] = 9007199254740992; }),
            "mesh: accessors[0]: accessor of 4 elements goes beyond its buffer view");
  EXPECT_EQ(refused([](Json& j) { j["bufferViews"][0]["byteLength"] = 9007199254740992; }),
            "mesh: bufferViews[0]: buffer view goes beyond its buffer");
  EXPECT_EQ(refused([](Json& j) { j["bufferViews"][0]["byteStride"] = 4; }),
            "mesh: bufferViews[0]: byte stride 4 does not fit elements of 12 bytes");
  EXPECT_EQ(refused([](Json& j) { j["accessors"][1]["componentType"] = 5122; }),
            "mesh: accessors[1]: indices must have an unsigned component type, not 5122");
  EXPECT_EQ(refused([](Json& j) { j["meshes"][0]["primitives"][0]["mode"] = 7; }),
            "mesh: meshes[0].primitives[0]: mode 7 is unknown: the modes are 0 to 6");
  EXPECT_EQ(refused([](Json& j) { j["nodes"][0]["children"] = {0}; }),
            "mesh: nodes[0]: node is reached twice: nodes must form trees");
  EXPECT_EQ(refused([](Json& j) { j["nodes"][0]["mesh"] = 1; }),
            "mesh: nodes[0]: meshes[1] does not exist");
  EXPECT_EQ(refused([](Json& j) {
              j["nodes"][0]["scale"] = {1, 2};
            }),
            "mesh: nodes[0].scale: is not an array of 3 numbers");
  EXPECT_EQ(refused([](Json& j) { j["meshes"][0]["primitives"][0]["mode"] = 1; }),
            "mesh: the scene has no triangles: there is no surface to read");

  Asset bad_index = square();
  bad_index.bytes[48] = 4;
  EXPECT_EQ(refusal(read_gltf, bad_index.text()),
            "mesh: meshes[0].primitives[0]: vertex index 4 is out of range: 4 vertices");
  Json other = square().json;
  other["buffers"] = {{{"byteLength", 60}, {"uri", "other.bin"}}};
  EXPECT_EQ(
      refusal(read_gltf, other.dump()),
      "mesh: buffers[0]: a buffer must be in the glTF file, in a data URI or in a file beside it");
}

TEST(GltfReader, UnknownExtensionsAreOneWarningEach) {
  Asset asset = square();
  asset.json["extensionsUsed"] = {"KHR_materials_unlit", "KHR_materials_unheard_of",
                                  "EXT_mesh_gpu_instancing", "KHR_texture_basisu"};
  const std::string unheard =
      "mesh: extensionsUsed[1]: extension 'KHR_materials_unheard_of' is not read";
  EXPECT_EQ(read_all(asset.text()).warnings, std::vector{unheard});
  EXPECT_EQ(read_all(asset.text(), ReadParts::kMeshAndAppearance).warnings,
            (std::vector{unheard, std::string("mesh: extensionsUsed[3]: extension "
                                              "'KHR_texture_basisu' is not read")}));
  asset.json["extensionsRequired"] = {"KHR_texture_basisu"};  // The shape does not need it.
  EXPECT_EQ(read_all(asset.text()).mesh.triangles.size(), 2u);
  EXPECT_THROW(read_all(asset.text(), ReadParts::kMeshAndAppearance), Error);
}

TEST(GltfReader, AWrongLengthInTheHeaderIsAWarningIfTheChunksEndWithTheFile) {
  for (const char* length : {"\0\0\0\0", "\1\0\0\0", "\xFF\xFF\xFF\xFF"}) {
    std::string glb = square().glb();
    glb.replace(8, 4, length, 4);
    const MeshWithAppearance result = read_all(glb);
    EXPECT_EQ(result.mesh.vertices, kSquareVertices);
    ASSERT_EQ(result.warnings.size(), 1u);
    EXPECT_NE(result.warnings[0].find("all chunks are read"), std::string::npos);
    EXPECT_NE(refusal(read_gltf, glb.substr(0, glb.size() - 1)), "no error");
  }
}

TEST(GltfReader, HarmlessFaultsAreRead) {
  Asset asset = square();
  asset.json["bufferViews"][0]["byteStride"] = 0;
  asset.json["accessors"].push_back({{"componentType", 5126}, {"count", 0}, {"type", "VEC3"}});
  asset.primitive({{"attributes", {{"POSITION", 2}}}});
  asset.primitive({{"attributes", {{"POSITION", 0}}}, {"indices", 2}});
  asset.json["nodes"][0]["matrix"] = {1, 0, 0, 1e-9, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0.9999999};
  asset.json["extras"] = "";
  std::string glb;
  std::size_t end = 0;
  do {  // until the JSON is padded
    asset.json["extras"] = asset.json["extras"].get<std::string>() + "x";
    glb = asset.glb();
    end = glb.find("BIN") - 4;
  } while (glb[end - 1] != ' ');
  for (std::size_t at = end; glb[at - 1] == ' ';) glb[--at] = '\0';
  const MeshWithAppearance result = read_all(glb);
  EXPECT_EQ(result.mesh.vertices, kSquareVertices);
  EXPECT_EQ(result.warnings, std::vector{std::string(
                                 "mesh: 1 matrices whose last row is nearly 0 0 0 1 are taken as "
                                 "if it was")});
  asset.json["nodes"][0]["matrix"][3] = 1e-3;
  EXPECT_EQ(refusal(read_gltf, asset.text()),
            "mesh: nodes[0]: the last row of the matrix must be 0 0 0 1");
}

TEST(GltfReader, DataUrisInEverySpelling) {
  const Asset asset = square();
  std::string lines = base64(asset.bytes);
  for (std::size_t at = 60; at < lines.size(); at += 62) lines.insert(at, "\r\n");
  Json json = asset.json;
  for (const std::string& uri :
       {"data:;base64," + base64(asset.bytes), "data:base64," + base64(asset.bytes),
        "data:application/octet-stream; base64," + base64(asset.bytes),
        "DATA:application/gltf-buffer;BASE64," + base64(asset.bytes),
        "data:a/b;c=d;base64, " + lines + "\n"}) {
    json["buffers"] = {{{"byteLength", asset.bytes.size()}, {"uri", uri}}};
    const MeshWithAppearance result = read_all(json.dump());
    EXPECT_EQ(result.mesh.vertices, kSquareVertices) << uri;
    EXPECT_TRUE(result.warnings.empty());
  }
  json["buffers"][0]["uri"] = "data:;base64,AA*A";
  EXPECT_EQ(refusal(read_gltf, json.dump()), "mesh: buffers[0]: data URI is not base64");
}

TEST(GltfReader, ABufferThatIsTooShortMattersOnlyToItsViews) {
  Asset asset = square();
  Json json = asset.json;
  const std::string uri = "data:;base64," + base64(asset.bytes);
  json["buffers"] = {{{"byteLength", asset.bytes.size() + 1}, {"uri", uri}}};
  const MeshWithAppearance result = read_all(json.dump() + std::string(3, '\0'));
  EXPECT_EQ(result.mesh.vertices, kSquareVertices);
  EXPECT_EQ(result.warnings,
            std::vector{std::string("mesh: buffers[0]: buffer of 60 bytes, but 61 are declared")});
  json["bufferViews"][1]["byteLength"] = 13;
  EXPECT_EQ(refusal(read_gltf, json.dump()),
            "mesh: buffers[0]: buffer of 60 bytes, but 61 are declared");
}

TEST(GltfReader, TooManyInstancesAreRefusedBeforeTheyAreMade) {
  Asset asset;
  asset.accessor(asset.view(kSquarePoints), 5126, 4, "VEC3");
  asset.accessor(asset.view(std::vector<std::uint8_t>(60'000, 0)), 5121, 60'000, "SCALAR");
  for (int i = 0; i < 1000; ++i)
    asset.primitive({{"attributes", {{"POSITION", 0}}}, {"indices", 1}});
  for (int i = 0; i < 100'000; ++i) {
    asset.json["nodes"][i] = {{"mesh", 0}};
    asset.json["scenes"][0]["nodes"][i] = i;
  }
  EXPECT_EQ(refusal(read_gltf, asset.text()),
            "mesh: 2000000000000 triangles are too many: at most 1,431,655,765 are read");
}

TEST(GltfReader, DeepNestingIsSafe) {
  const std::string deep =
      "{\"asset\":{\"version\":\"2.0\"},\"extras\":" + std::string(200'000, '[');
  refusal(read_gltf, deep);
  refusal(read_gltf, deep + std::string(200'000, ']') + "}");
}

TEST(GltfReader, AnyPrefixIsSafe) {
  expect_any_prefix_is_safe(read_gltf, square().text());
  expect_any_prefix_is_safe(read_gltf, square().glb());
}

}  // namespace
}  // namespace voxdag
