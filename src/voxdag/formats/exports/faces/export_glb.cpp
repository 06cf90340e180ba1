
#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/core/io/descriptor.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/core/io/nameless_file.hpp"
#include "voxdag/core/srgb.hpp"
#include "voxdag/formats/exports/coordinates.hpp"
#include "voxdag/formats/exports/faces/export_faces.hpp"
#include "voxdag/formats/exports/faces/exported_polygons.hpp"
#include "voxdag/formats/exports/json_of.hpp"
#include "voxdag/image/png.hpp"

namespace voxdag {
namespace {

constexpr std::uint64_t kMaxGlbBytes = 0xFFFFFFFF;
constexpr std::uint64_t kIndexBytes = 3 * sizeof(std::uint32_t);  ///< The indices of a triangle.

struct ColoredCorner {
  Vec3f place;
  std::uint16_t red, green, blue, alpha;  ///< Linear.
};
static_assert(sizeof(ColoredCorner) == 20);

struct TexturedCorner {
  Vec3f place;
  Vec2f uv;
};
static_assert(sizeof(TexturedCorner) == 20);

std::uint16_t linear16(std::uint8_t srgb) {
  return static_cast<std::uint16_t>(srgb_to_linear(static_cast<float>(srgb) / 255) * 65535 + 0.5f);
}

/// Returns the PNG file of an image, padded with zeros to a multiple of 4 bytes.
std::string png_bytes(const ImageRgb8& image) {
  // AtomicFile writes to no descriptor that programs do not inherit.
  const Descriptor memory = open_memory_file(/*is_inherited=*/true);
  const std::filesystem::path path = path_of_descriptor(memory.get());
  write_png(path, image);
  std::string bytes(MappedFile(path).text());
  bytes.resize((bytes.size() + 3) & ~std::size_t{3});
  return bytes;
}

/// Computes the sizes and the JSON of a GLB file from the numbers of its corners and triangles.
struct GlbPlan {
  Grid grid;
  Vec3i origin;   ///< The voxel at the origin of the mesh's coordinates, if they are in voxels.
  bool is_world;  ///< The mesh's coordinates are in world units.
  bool has_colors;
  ExportedPolygons::Extent extent;
  std::string texture;  ///< A PNG file, or empty.

  Vec3f place(Vec3d corner) const {
    return Vec3f(is_world ? grid.to_world(corner) : corner - Vec3d(origin));
  }
  std::uint64_t stride() const { return has_colors ? sizeof(ColoredCorner) : sizeof(Vec3f); }
  std::uint64_t corners() const { return extent.vertices; }
  std::uint64_t corner_bytes() const { return corners() * stride(); }
  std::uint64_t index_bytes() const { return extent.triangles * kIndexBytes; }
  std::uint64_t data_bytes() const { return corner_bytes() + index_bytes() + texture.size(); }

  /// Adds the mesh, which must not be empty, to the document.
  void add_mesh(nlohmann::ordered_json& json) const {
    constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;
    constexpr int kFloat = 5126, kUnsignedShort = 5123, kUnsignedInt = 5125;
    nlohmann::ordered_json attributes = {{"POSITION", 0}};
    const bool has_texture = !texture.empty();
    if (has_colors) attributes[has_texture ? "TEXCOORD_0" : "COLOR_0"] = 2;
    nlohmann::ordered_json primitive = {
        {"attributes", attributes}, {"indices", 1}, {"material", 0}};
    json["meshes"] = {{{"primitives", {primitive}}}};
    const Vec3d color = has_colors ? Vec3d{1, 1, 1} : Vec3d{0.62, 0.6, 0.57};
    json["materials"] = {{{"pbrMetallicRoughness",
                           {{"baseColorFactor", {color.x, color.y, color.z, 1}},
                            {"metallicFactor", 0},
                            {"roughnessFactor", 1}}}}};
    if (has_texture) {
      constexpr int kNearest = 9728, kClampToEdge = 33071;
      json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
      json["textures"] = {{{"sampler", 0}, {"source", 0}}};
      json["samplers"] = {{{"magFilter", kNearest},
                           {"minFilter", kNearest},
                           {"wrapS", kClampToEdge},
                           {"wrapT", kClampToEdge}}};
      json["images"] = {{{"bufferView", 2}, {"mimeType", "image/png"}}};
    }
    json["buffers"] = {{{"byteLength", data_bytes()}}};
    json["bufferViews"] = {{{"buffer", 0},
                            {"byteLength", corner_bytes()},
                            {"byteStride", stride()},
                            {"target", kArrayBuffer}},
                           {{"buffer", 0},
                            {"byteOffset", corner_bytes()},
                            {"byteLength", index_bytes()},
                            {"target", kElementArrayBuffer}}};
    if (has_texture)
      json["bufferViews"].push_back({{"buffer", 0},
                                     {"byteOffset", corner_bytes() + index_bytes()},
                                     {"byteLength", texture.size()}});
    json["accessors"] = {{{"bufferView", 0},
                          {"componentType", kFloat},
                          {"count", corners()},
                          {"type", "VEC3"},
                          {"min", json_of(place(extent.bounds.lo))},
                          {"max", json_of(place(extent.bounds.hi))}},
                         {{"bufferView", 1},
                          {"componentType", kUnsignedInt},
                          {"count", 3 * extent.triangles},
                          {"type", "SCALAR"}}};
    if (has_texture)
      json["accessors"].push_back({{"bufferView", 0},
                                   {"byteOffset", sizeof(Vec3f)},
                                   {"componentType", kFloat},
                                   {"count", corners()},
                                   {"type", "VEC2"}});
    else if (has_colors)
      json["accessors"].push_back({{"bufferView", 0},
                                   {"byteOffset", sizeof(Vec3f)},
                                   {"componentType", kUnsignedShort},
                                   {"normalized", true},
                                   {"count", corners()},
                                   {"type", "VEC4"}});
  }

  /// Returns the document, padded to a multiple of 4 bytes.
  std::string document() const {
    const double side = grid.voxel_size;
    nlohmann::ordered_json node = {{"name", "voxels"}};
    if (!is_world) {
      node["translation"] = json_of(grid.to_world(Vec3d(origin)));
      node["scale"] = json_of(Vec3d{side, side, side});
    }
    if (extent.triangles > 0) node["mesh"] = 0;
    node["extras"] = {{"grid",
                       {{"resolution", grid.resolution()},
                        {"origin", json_of(grid.origin)},
                        {"voxel_size", side}}}};
    nlohmann::ordered_json json;
    json["asset"] = {{"version", "2.0"}, {"generator", "voxdag"}};
    json["scene"] = 0;
    json["scenes"] = {{{"nodes", {0}}}};
    json["nodes"] = nlohmann::ordered_json::array({node});  // {node} may be a copy of node.
    if (extent.triangles > 0) add_mesh(json);
    std::string text = json.dump();
    text.resize((text.size() + 3) & ~std::size_t{3}, ' ');
    return text;
  }
};

void write_word(AtomicFile& file, std::uint64_t word) {
  const auto value = static_cast<std::uint32_t>(word);
  file.write(&value, sizeof value);
}

void write_corners(AtomicFile& file, const GlbPlan& plan, const FacePolygon& polygon,
                   const SharedVertices& vertices) {
  const Value8 color = polygon.color;
  const Vec2f uv = plan.texture.empty() ? Vec2f{} : plan.extent.texture.uv(color);
  for (const Vec3d corner : vertices.added()) {
    const Vec3f place = plan.place(corner);
    if (!plan.texture.empty()) {
      const TexturedCorner textured{place, uv};
      file.write(&textured, sizeof textured);
    } else if (plan.has_colors) {
      const ColoredCorner colored{place, linear16(color.x), linear16(color.y), linear16(color.z),
                                  0xFFFF};
      file.write(&colored, sizeof colored);
    } else {
      file.write(&place, sizeof place);
    }
  }
}

}  // namespace

void export_glb(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                const ExportOptions& options) {
  const Box3i window = export_window(path, voxels, options);
  ExportedPolygons polygons(voxels, window, options, PolygonFormat::kVertexColors);
  GlbPlan plan{grid, window.lo, float_suffices(grid), polygons.has_colors(), polygons.measure(),
               {}};
  if (polygons.has_texture() && plan.extent.triangles > 0)
    plan.texture = png_bytes(plan.extent.texture.image());
  const std::string document = plan.document();
  const std::uint64_t data = plan.data_bytes();
  const std::uint64_t bytes = 12 + 8 + document.size() + (data > 0 ? 8 + data : 0);
  if (bytes > kMaxGlbBytes)
    refuse_export(path, std::to_string(plan.extent.triangles) + " triangles take " +
                            std::to_string(bytes) +
                            " bytes, more than the 4294967295 of a GLB file");
  check_disk_space(path, bytes);
  AtomicFile file(path);
  file.write("glTF");
  write_word(file, 2);
  write_word(file, bytes);
  write_word(file, document.size());
  file.write("JSON");
  file.write(document);
  if (data > 0) {
    write_word(file, data);
    file.write(std::string_view("BIN\0", 4));
    polygons.for_each(
        [&](const FacePolygon& polygon, const SharedVertices& vertices) {
          write_corners(file, plan, polygon, vertices);
        },
        0.8);
    polygons.for_each([&](const FacePolygon& polygon, const SharedVertices& vertices) {
      for (const std::array<std::uint32_t, 3>& triangle : polygon.triangles)
        for (const std::uint32_t corner : triangle) write_word(file, vertices.numbers()[corner]);
    });
    file.write(plan.texture);
  }
  file.commit();
}

}  // namespace voxdag
