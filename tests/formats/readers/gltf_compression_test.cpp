// Buffer views of meshoptimizer and primitives of Draco.
#include <draco/compression/encode.h>
#include <meshoptimizer.h>

#include "gltf_asset.hpp"

namespace voxdag {
namespace {

using namespace gltf_test;

/// Replaces the bytes of a buffer view by those that meshoptimizer makes of them.
void compress(Asset& asset, std::size_t view, const std::vector<unsigned char>& packed,
              std::size_t count, std::size_t stride, const char* mode) {
  Json& json = asset.json["bufferViews"][view];
  json["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},
                                                   {"byteOffset", asset.bytes.size()},
                                                   {"byteLength", packed.size()},
                                                   {"count", count},
                                                   {"byteStride", stride},
                                                   {"mode", mode}};
  asset.bytes.append(packed.begin(), packed.end());
  for (std::size_t i = 0; i < json["byteLength"].get<std::size_t>(); ++i)
    asset.bytes[json["byteOffset"].get<std::size_t>() + i] = '\xFF';
}

TEST(GltfReader, ViewsOfMeshoptCompression) {
  Asset asset = square();
  asset.json["extensionsRequired"] = {"EXT_meshopt_compression"};
  std::vector<unsigned char> packed(meshopt_encodeVertexBufferBound(4, 12));
  packed.resize(
      meshopt_encodeVertexBuffer(packed.data(), packed.size(), kSquarePoints.data(), 4, 12));
  compress(asset, 0, packed, 4, 12, "ATTRIBUTES");
  const std::vector<unsigned> indices = {0, 1, 2, 0, 2, 3};
  packed.assign(meshopt_encodeIndexSequenceBound(6, 4), 0);
  packed.resize(
      meshopt_encodeIndexSequence(packed.data(), packed.size(), indices.data(), indices.size()));
  compress(asset, 1, packed, 6, 2, "INDICES");
  const Mesh mesh = read_text(read_gltf, asset.text());
  EXPECT_EQ(mesh.vertices, kSquareVertices);
  EXPECT_EQ(mesh.triangles, (StoredVector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  // The extension of Khronos has the same format, and views may name a buffer that is missing.
  Json ratified = Json::parse(asset.text());
  for (Json& view : ratified["bufferViews"]) {
    view["extensions"] = {
        {"KHR_meshopt_compression", view["extensions"]["EXT_meshopt_compression"]}};
    view["buffer"] = 1;
  }
  ratified["extensionsRequired"] = {"KHR_meshopt_compression"};
  ratified["buffers"].push_back(
      {{"byteLength", 60},
       {"uri", "missing.bin"},
       {"extensions", {{"KHR_meshopt_compression", {{"fallback", true}}}}}});
  const MeshWithAppearance same = read_all(ratified.dump());
  EXPECT_EQ(same.mesh.vertices, kSquareVertices);
  EXPECT_TRUE(same.warnings.empty());
  Json& color = ratified["bufferViews"][0]["extensions"]["KHR_meshopt_compression"];
  color["filter"] = "COLOR";
  EXPECT_EQ(refusal(read_gltf, ratified.dump()),
            "mesh: bufferViews[0].extensions.KHR_meshopt_compression: the filter 'COLOR' is not "
            "supported");
  Asset newer = asset;
  newer.bytes[color["byteOffset"].get<std::size_t>()] = '\xA1';
  EXPECT_EQ(refusal(read_gltf, newer.text()),
            "mesh: bufferViews[0].extensions.EXT_meshopt_compression: version 1 of the compression "
            "of attributes is not supported");
  Asset cut = asset;
  Json& extension = cut.json["bufferViews"][1]["extensions"]["EXT_meshopt_compression"];
  extension["byteLength"] = 3;
  EXPECT_EQ(refusal(read_gltf, cut.text()),
            "mesh: bufferViews[1].extensions.EXT_meshopt_compression: the compressed bytes are "
            "malformed");
  extension["byteStride"] = 3;
  EXPECT_EQ(refusal(read_gltf, cut.text()),
            "mesh: bufferViews[1].extensions.EXT_meshopt_compression: count, stride, mode and "
            "filter do not fit together");
}

TEST(GltfReader, PrimitivesOfDracoCompression) {
  draco::Mesh mesh;
  mesh.set_num_points(4);
  mesh.SetNumFaces(2);
  mesh.SetFace(draco::FaceIndex(0),
               {draco::PointIndex(0), draco::PointIndex(1), draco::PointIndex(2)});
  mesh.SetFace(draco::FaceIndex(1),
               {draco::PointIndex(0), draco::PointIndex(2), draco::PointIndex(3)});
  draco::GeometryAttribute positions;
  positions.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
  const int id = mesh.AddAttribute(positions, true, 4);
  for (std::uint32_t p = 0; p < 4; ++p)
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(p), &kSquarePoints[3 * p]);
  draco::EncoderBuffer buffer;
  draco::Encoder encoder;
  encoder.SetEncodingMethod(draco::MESH_SEQUENTIAL_ENCODING);
  ASSERT_TRUE(encoder.EncodeMeshToBuffer(mesh, &buffer).ok());

  Asset asset;
  asset.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  const auto view = asset.view(std::vector<char>(buffer.data(), buffer.data() + buffer.size()));
  asset.json["accessors"] = {{{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
                             {{"componentType", 5123}, {"count", 6}, {"type", "SCALAR"}}};
  Json extension = {{"bufferView", view},
                    {"attributes", {{"POSITION", mesh.attribute(id)->unique_id()}}}};
  asset.primitive({{"attributes", {{"POSITION", 0}}},
                   {"indices", 1},
                   {"extensions", {{"KHR_draco_mesh_compression", extension}}}});
  const Mesh read = read_text(read_gltf, asset.text());
  EXPECT_EQ(read.vertices, kSquareVertices);
  EXPECT_EQ(read.triangles, (StoredVector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  asset.json["accessors"][0]["count"] = 5;
  EXPECT_EQ(refusal(read_gltf, asset.text()),
            "mesh: accessors[0]: 48 bytes are decoded for 5 elements");
  for (std::size_t size = 0; size < buffer.size(); ++size) {
    asset.json["bufferViews"][0]["byteLength"] = size;
    EXPECT_THROW(read_text(read_gltf, asset.text()), Error) << size;
  }
}

}  // namespace
}  // namespace voxdag
