#include "voxdag/formats/readers/gltf/gltf_reader.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "formats/readers/mesh_text.hpp"

namespace voxdag {
namespace {

using Json = nlohmann::json;

std::string base64(const std::string& bytes) {
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
  }
  return out;
}

/// Builds an asset whose parts can be changed before it is written.
struct Asset {
  Json json = {{"asset", {{"version", "2.0"}}},
               {"scene", 0},
               {"scenes", {{{"nodes", {0}}}}},
               {"nodes", {{{"mesh", 0}}}}};
  std::string bytes;

  /// Adds a buffer view with the values and returns its index.
  template <class T>
  std::size_t view(const std::vector<T>& values, std::size_t stride = 0) {
    Json view = {
        {"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * sizeof(T)}};
    if (stride > 0) view["byteStride"] = stride;
    for (const T value : values) append(bytes, value);
    json["bufferViews"].push_back(view);
    return json["bufferViews"].size() - 1;
  }
  std::size_t accessor(std::size_t view, int component, std::size_t count, const char* type) {
    json["accessors"].push_back(
        {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
    return json["accessors"].size() - 1;
  }
  Json& primitive(Json primitive) {
    json["meshes"][0]["primitives"].push_back(primitive);
    return json["meshes"][0]["primitives"].back();
  }

  std::string text() const {
    Json whole = json;
    whole["buffers"] = {{{"byteLength", bytes.size()},
                         {"uri", "data:application/octet-stream;base64," + base64(bytes)}}};
    return whole.dump();
  }
  std::string glb() const {
    Json whole = json;
    whole["buffers"] = {{{"byteLength", bytes.size()}}};
    std::string chunk = whole.dump(), out = "glTF";
    while (chunk.size() % 4) chunk += ' ';
    append<std::uint32_t>(out, 2);
    append(out, static_cast<std::uint32_t>(28 + chunk.size() + bytes.size()));
    append(out, static_cast<std::uint32_t>(chunk.size()));
    out += "JSON" + chunk;
    append(out, static_cast<std::uint32_t>(bytes.size()));
    return out + std::string("BIN\0", 4) + bytes;
  }
};

const std::vector<float> kPoints = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
const StoredVector<Vec3f> kVertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

Asset square() {
  Asset asset;
  asset.accessor(asset.view(kPoints), 5126, 4, "VEC3");
  asset.accessor(asset.view<std::uint16_t>({0, 1, 2, 0, 2, 3}), 5123, 6, "SCALAR");
  asset.primitive({{"attributes", {{"POSITION", 0}}}, {"indices", 1}});
  return asset;
}

TEST(GltfReader, IndexedTrianglesFromJsonAndBinary) {
  for (const std::string& bytes : {square().text(), square().glb()}) {
    const Mesh mesh = read_text(read_gltf, bytes);
    EXPECT_EQ(mesh.vertices, kVertices);
    EXPECT_EQ(mesh.triangles, (StoredVector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_TRUE(mesh.materials.empty());
  }
}

TEST(GltfReader, EveryIndexTypeAndEveryTriangleMode) {
  Asset asset;
  asset.accessor(asset.view(kPoints), 5126, 4, "VEC3");
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
  EXPECT_EQ(mesh.vertices, kVertices);  // shared by all primitives of the mesh
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
  EXPECT_EQ(refusal(read_gltf, asset.text()),
            "mesh: accessors[0]: positions must have component type 5126 (float), not 5122");
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
  EXPECT_EQ(refused([](Json& j) { j["extensionsRequired"] = {"KHR_draco_mesh_compression"}; }),
            "mesh: extensionsRequired[0]: extension 'KHR_draco_mesh_compression' is not supported");
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
  EXPECT_EQ(refused([](Json& j) {
              j["nodes"][0]["scale"] = {1e39, 1, 1};
            }),
            "mesh: meshes[0].primitives[0]: vertex 1 is not finite and a triangle uses it");
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

TEST(GltfReader, TooManyInstancesAreRefusedBeforeTheyAreMade) {
  Asset asset;
  asset.accessor(asset.view(kPoints), 5126, 4, "VEC3");
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
