#pragma once
/// A glTF asset that tests build, and the mesh that is read of it.
#include <nlohmann/json.hpp>

#include "formats/readers/mesh_text.hpp"
#include "voxdag/formats/readers/gltf/gltf_reader.hpp"

namespace voxdag::gltf_test {

using Json = nlohmann::json;

inline std::string base64(const std::string& bytes) {
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

inline const std::vector<float> kSquarePoints = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
inline const StoredVector<Vec3f> kSquareVertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

/// A square of two triangles.
inline Asset square() {
  Asset asset;
  asset.accessor(asset.view(kSquarePoints), 5126, 4, "VEC3");
  asset.accessor(asset.view<std::uint16_t>({0, 1, 2, 0, 2, 3}), 5123, 6, "SCALAR");
  asset.primitive({{"attributes", {{"POSITION", 0}}}, {"indices", 1}});
  return asset;
}

/// Returns the mesh with its warnings.
inline MeshWithAppearance read_all(const std::string& bytes, ReadParts parts = ReadParts::kMesh) {
  return read_gltf({bytes, "mesh", {}, nullptr, {}}, parts);
}

}  // namespace voxdag::gltf_test
