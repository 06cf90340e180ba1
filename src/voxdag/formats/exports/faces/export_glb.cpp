#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/core/srgb.hpp"
#include "voxdag/formats/exports/coordinates.hpp"
#include "voxdag/formats/exports/faces/export_faces.hpp"
#include "voxdag/formats/exports/faces/exported_rectangles.hpp"
#include "voxdag/formats/exports/json_of.hpp"

namespace voxdag {
namespace {

constexpr std::uint64_t kMaxGlbBytes = 0xFFFFFFFF;
constexpr std::uint64_t kIndexBytes = 6 * sizeof(std::uint32_t);  ///< The indices of a rectangle.

struct ColoredCorner {
  Vec3f place;
  std::uint16_t red, green, blue, alpha;  ///< Linear.
};
static_assert(sizeof(ColoredCorner) == 20);

std::uint16_t linear16(std::uint8_t srgb) {
  return static_cast<std::uint16_t>(srgb_to_linear(static_cast<float>(srgb) / 255) * 65535 + 0.5f);
}

/// Computes the sizes and the JSON of a GLB file from the number of its rectangles.
struct GlbPlan {
  Grid grid;
  Vec3i origin;   ///< The voxel at the origin of the mesh's coordinates, if they are in voxels.
  bool is_world;  ///< The mesh's coordinates are in world units.
  bool has_colors;
  ExportedRectangles::Extent extent;

  Vec3f place(Vec3i corner) const {
    return is_world ? Vec3f(grid.to_world(Vec3d(corner))) : Vec3f(corner - origin);
  }
  std::uint64_t stride() const { return has_colors ? sizeof(ColoredCorner) : sizeof(Vec3f); }
  std::uint64_t corners() const { return 4 * extent.count; }
  std::uint64_t corner_bytes() const { return corners() * stride(); }
  std::uint64_t data_bytes() const { return corner_bytes() + extent.count * kIndexBytes; }

  /// Adds the mesh, which must not be empty, to the document.
  void add_mesh(nlohmann::ordered_json& json) const {
    constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;
    constexpr int kFloat = 5126, kUnsignedShort = 5123, kUnsignedInt = 5125;
    nlohmann::ordered_json attributes = {{"POSITION", 0}};
    if (has_colors) attributes["COLOR_0"] = 2;
    nlohmann::ordered_json primitive = {
        {"attributes", attributes}, {"indices", 1}, {"material", 0}};
    json["meshes"] = {{{"primitives", {primitive}}}};
    const Vec3d color = has_colors ? Vec3d{1, 1, 1} : Vec3d{0.62, 0.6, 0.57};
    json["materials"] = {{{"pbrMetallicRoughness",
                           {{"baseColorFactor", {color.x, color.y, color.z, 1}},
                            {"metallicFactor", 0},
                            {"roughnessFactor", 1}}}}};
    json["buffers"] = {{{"byteLength", data_bytes()}}};
    json["bufferViews"] = {{{"buffer", 0},
                            {"byteLength", corner_bytes()},
                            {"byteStride", stride()},
                            {"target", kArrayBuffer}},
                           {{"buffer", 0},
                            {"byteOffset", corner_bytes()},
                            {"byteLength", extent.count * kIndexBytes},
                            {"target", kElementArrayBuffer}}};
    json["accessors"] = {{{"bufferView", 0},
                          {"componentType", kFloat},
                          {"count", corners()},
                          {"type", "VEC3"},
                          {"min", json_of(Vec3d(place(extent.bounds.lo)))},
                          {"max", json_of(Vec3d(place(extent.bounds.hi)))}},
                         {{"bufferView", 1},
                          {"componentType", kUnsignedInt},
                          {"count", 6 * extent.count},
                          {"type", "SCALAR"}}};
    if (has_colors)
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
      node["scale"] = json_of({side, side, side});
    }
    if (extent.count > 0) node["mesh"] = 0;
    node["extras"] = {{"grid",
                       {{"resolution", grid.resolution()},
                        {"origin", json_of(grid.origin)},
                        {"voxel_size", side}}}};
    nlohmann::ordered_json json;
    json["asset"] = {{"version", "2.0"}, {"generator", "voxdag"}};
    json["scene"] = 0;
    json["scenes"] = {{{"nodes", {0}}}};
    json["nodes"] = {node};
    if (extent.count > 0) add_mesh(json);
    std::string text = json.dump();
    text.resize((text.size() + 3) & ~std::size_t{3}, ' ');
    return text;
  }
};

void write_word(AtomicFile& file, std::uint64_t word) {
  const auto value = static_cast<std::uint32_t>(word);
  file.write(&value, sizeof value);
}

void write_corners(AtomicFile& file, const GlbPlan& plan, const FaceRectangle& rectangle) {
  for (const Vec3i corner : corners_of(rectangle)) {
    const Vec3f place = plan.place(corner);
    if (!plan.has_colors) {
      file.write(&place, sizeof place);
    } else {
      const Value8 color = rectangle.color;
      const ColoredCorner colored{place, linear16(color.x), linear16(color.y), linear16(color.z),
                                  0xFFFF};
      file.write(&colored, sizeof colored);
    }
  }
}

void write_indices(AtomicFile& file, std::uint64_t rectangles) {
  for (std::uint64_t i = 0; i < rectangles; ++i) {
    const auto first = static_cast<std::uint32_t>(4 * i);
    const std::array indices{first, first + 1, first + 2, first, first + 2, first + 3};
    file.write(indices.data(), sizeof indices);
  }
}

}  // namespace

void export_glb(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                const ExportOptions& options) {
  const Box3i window = export_window(path, voxels, options);
  ExportedRectangles rectangles(voxels, window, options, true);
  const GlbPlan plan{grid, window.lo, float_suffices(grid), rectangles.has_colors(),
                     rectangles.measure()};
  const std::string document = plan.document();
  const std::uint64_t data = plan.data_bytes();
  const std::uint64_t bytes = 12 + 8 + document.size() + (data > 0 ? 8 + data : 0);
  if (bytes > kMaxGlbBytes)
    refuse_export(path, std::to_string(plan.extent.count) + " rectangles take " +
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
    rectangles.for_each(
        [&](const FaceRectangle& rectangle) { write_corners(file, plan, rectangle); });
    write_indices(file, plan.extent.count);
  }
  file.commit();
}

}  // namespace voxdag
