// Skins, morph targets, instances and mirrored nodes: where vertices lie.
#include <cmath>

#include "gltf_asset.hpp"

namespace voxdag {
namespace {

using namespace gltf_test;

TEST(GltfReader, SkinsPlaceVerticesByTheirJointsInRestPoseAndIgnoreTheirNode) {
  Asset asset = square();
  asset.accessor(asset.view<std::uint8_t>({0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}), 5121,
                 4, "VEC4");
  // The third vertex is held by both joints alike, with weights whose sum is not 1.
  asset.accessor(asset.view<float>({1, 0, 0, 0, 0, 1, 0, 0, 3, 3, 0, 0, 1, 0, 0, 0}), 5126, 4,
                 "VEC4");
  std::vector<float> binds;
  for (const float x : {0.0f, -1.0f})
    for (const float value :
         {1.f, 0.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 0.f, 1.f, 0.f, x, 0.f, 0.f, 1.f})
      binds.push_back(value);
  asset.accessor(asset.view(binds), 5126, 2, "MAT4");
  asset.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = 2;
  asset.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = 3;
  asset.json["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", 4}}};
  asset.json["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"scale", {100, 100, 100}}},
                         {{"translation", {0, 0, 10}}, {"children", {2}}},
                         {{"translation", {1, 0, 10}}, {"scale", {2, 2, 2}}}};
  asset.json["scenes"][0]["nodes"] = {0, 1};
  // Joint 0 moves by (0, 0, 10); joint 1 maps p to (1, 0, 20) + 2 (p - (1, 0, 0)).
  EXPECT_EQ(read_text(read_gltf, asset.text()).vertices,
            (StoredVector<Vec3f>{{0, 0, 10}, {1, 0, 20}, {1, 1.5f, 15}, {0, 1, 10}}));
  Asset elsewhere = asset;  // The joints are outside of the scene, then below a hidden node.
  elsewhere.json["scenes"][0]["nodes"] = {0};
  EXPECT_EQ(read_text(read_gltf, elsewhere.text()).vertices[1], (Vec3f{1, 0, 20}));
  elsewhere.json["nodes"].push_back(
      {{"children", {1}}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
  elsewhere.json["scenes"][0]["nodes"] = {3, 0};
  EXPECT_EQ(read_text(read_gltf, elsewhere.text()).vertices[1], (Vec3f{1, 0, 20}));
  const auto joints = asset.json["bufferViews"][2]["byteOffset"].get<std::size_t>();
  asset.bytes[joints + 1] = 9;  // A joint without weight may be any.
  EXPECT_EQ(read_text(read_gltf, asset.text()).vertices[0], (Vec3f{0, 0, 10}));
  asset.bytes[joints] = 7;
  EXPECT_EQ(refusal(read_gltf, asset.text()),
            "mesh: meshes[0].primitives[0]: a joint of vertex 0 does not exist: the skin has 2");
}

TEST(GltfReader, MorphTargetsMoveVerticesByTheWeightsOfTheNodeOrElseOfTheMesh) {
  Asset asset = square();
  asset.accessor(asset.view<float>({0, 0, 2, 0, 0, 2, 0, 0, 2, 0, 0, 2}), 5126, 4, "VEC3");
  asset.accessor(asset.view<float>({8, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}), 5126, 4, "VEC3");
  Json& mesh = asset.json["meshes"][0];
  mesh["primitives"][0]["targets"] = {{{"POSITION", 2}}, {{"POSITION", 3}}};
  EXPECT_EQ(read_text(read_gltf, asset.text()).vertices, kSquareVertices);  // without weights
  mesh["weights"] = {0.5, 0};
  EXPECT_EQ(read_text(read_gltf, asset.text()).vertices[0], (Vec3f{0, 0, 1}));
  asset.json["nodes"][0]["weights"] = {0, 0.25};
  EXPECT_EQ(read_text(read_gltf, asset.text()).vertices[0], (Vec3f{2, 0, 0}));
}

TEST(GltfReader, GpuInstancesShowTheMeshOnceEach) {
  Asset asset = square();
  asset.accessor(asset.view<float>({0, 0, 0, 5, 0, 0}), 5126, 2, "VEC3");
  asset.accessor(asset.view<float>({1, 1, 1, 2, 2, 2}), 5126, 2, "VEC3");
  asset.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  Json& node = asset.json["nodes"][0];
  node["translation"] = {0, 0, 3};
  node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", 2}, {"SCALE", 3}};
  const Mesh mesh = read_text(read_gltf, asset.text());
  ASSERT_EQ(mesh.vertices.size(), 8u);
  EXPECT_EQ(mesh.vertices[2], (Vec3f{1, 1, 3}));
  EXPECT_EQ(mesh.vertices[4 + 2], (Vec3f{7, 2, 3}));
  asset.json["accessors"][3]["count"] = 1;
  EXPECT_EQ(refusal(read_gltf, asset.text()),
            "mesh: nodes[0].extensions.EXT_mesh_gpu_instancing.attributes: the attributes of "
            "instances differ in number");
}

TEST(GltfReader, MirroredNodesTurnTrianglesOver) {
  Asset asset = square();
  asset.json["nodes"] = {{{"mesh", 0}, {"scale", {-1, 1, 1}}},
                         {{"mesh", 0}, {"scale", {-1, -1, 1}}}};
  asset.json["scenes"][0]["nodes"] = {0, 1};
  EXPECT_EQ(read_text(read_gltf, asset.text()).triangles,
            (StoredVector<Triangle>{{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}}));
}

}  // namespace
}  // namespace voxdag
