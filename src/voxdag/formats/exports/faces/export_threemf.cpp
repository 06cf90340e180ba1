#include <array>
#include <cstdio>
#include <string>
#include <utility>

#include "voxdag/core/error.hpp"
#include "voxdag/formats/exports/coordinates.hpp"
#include "voxdag/formats/exports/faces/export_faces.hpp"
#include "voxdag/formats/exports/faces/exported_polygons.hpp"
#include "voxdag/formats/exports/zip_file.hpp"

namespace voxdag {
namespace {

constexpr std::uint64_t kMaxVertices = 0x7FFFFFFF;  ///< Indices have 31 bits.
/// At most the bytes of a vertex, a triangle or a colour, and of the rest of the model.
constexpr std::uint64_t kMostEntryBytes = 128;
constexpr std::size_t kTextBytes = 1 << 16;

constexpr const char* kContentTypes =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>
)";
constexpr const char* kRelationships =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
)";

std::string unit_attribute(const std::string& unit) {
  constexpr std::pair<const char*, const char*> kUnits[] = {
      {"mm", "millimeter"}, {"cm", "centimeter"}, {"m", "meter"}, {"in", "inch"}, {"ft", "foot"}};
  for (const auto& [name, in_file] : kUnits)
    if (unit == name) return std::string(" unit=\"") + in_file + "\"";
  return {};
}

/// Writes the parts of a model's text to an archive.
class ModelText {
 public:
  explicit ModelText(ZipFile& file) : file_(file) {}
  ModelText& add(std::string_view text) {
    text_.append(text);
    if (text_.size() >= kTextBytes) flush();
    return *this;
  }
  void flush() {
    file_.write(text_);
    text_.clear();
  }

 private:
  ZipFile& file_;
  std::string text_;
};

void write_colors(const ColorTexture& colors, ModelText& text) {
  text.add("<m:colorgroup id=\"2\">\n");
  colors.for_each([&](std::uint32_t code) {
    std::array<char, 8> hex;
    std::snprintf(hex.data(), hex.size(), "#%06X", code);
    text.add("<m:color color=\"").add(hex.data()).add("\"/>\n");
  });
  text.add("</m:colorgroup>\n");
}

void write_vertex(Vec3d place, bool use_float, ModelText& text) {
  text.add("<vertex");
  for (int axis = 0; axis < 3; ++axis)
    text.add(std::array{" x=\"", " y=\"", " z=\""}[static_cast<std::size_t>(axis)])
        .add(use_float ? shortest(static_cast<float>(place[axis])) : shortest(place[axis]))
        .add("\"");
  text.add("/>\n");
}

}  // namespace

void export_3mf(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                const ExportOptions& options) {
  refuse_pipe(path);
  const Box3i window = export_window(path, voxels, options);
  ExportedPolygons polygons(voxels, window, options, PolygonFormat::kFaceColors);
  const ExportedPolygons::Extent extent = polygons.measure();
  if (extent.triangles == 0)
    throw Error(path.string(), "", "a 3MF file has a body, but there are no voxels");
  if (extent.vertices > kMaxVertices)
    refuse_export(path, std::to_string(extent.vertices) +
                            " vertices are more than the 2147483647 of a 3MF file");
  ZipFile file(path);
  file.begin("[Content_Types].xml");
  file.write(kContentTypes);
  file.begin("_rels/.rels");
  file.write(kRelationships);
  constexpr std::uint64_t kMostColors = std::uint64_t{1} << 24;
  file.begin("3D/3dmodel.model",
             (extent.vertices + extent.triangles + kMostColors) * kMostEntryBytes);
  ModelText text(file);
  text.add(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<model xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
      "xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\"");
  text.add(unit_attribute(options.unit)).add(">\n<resources>\n");
  if (polygons.has_colors()) write_colors(extent.texture, text);
  text.add(polygons.has_colors() ? "<object id=\"1\" type=\"model\" pid=\"2\" pindex=\"0\">\n"
                                 : "<object id=\"1\" type=\"model\">\n");
  text.add("<mesh>\n<vertices>\n");
  const bool use_float = float_suffices(grid);
  polygons.for_each(
      [&](const FacePolygon&, const SharedVertices& vertices) {
        for (const Vec3d place : vertices.added())
          write_vertex(grid.to_world(place), use_float, text);
      },
      0.7);
  text.add("</vertices>\n<triangles>\n");
  polygons.for_each([&](const FacePolygon& polygon, const SharedVertices& vertices) {
    const std::string color =
        polygons.has_colors()
            ? "\" pid=\"2\" p1=\"" + std::to_string(extent.texture.index_of(polygon.color))
            : std::string();
    for (const auto& [a, b, c] : polygon.triangles)
      text.add("<triangle v1=\"")
          .add(std::to_string(vertices.numbers()[a]))
          .add("\" v2=\"")
          .add(std::to_string(vertices.numbers()[b]))
          .add("\" v3=\"")
          .add(std::to_string(vertices.numbers()[c]))
          .add(color)
          .add("\"/>\n");
  });
  text.add(
      "</triangles>\n</mesh>\n</object>\n</resources>\n<build>\n<item objectid=\"1\"/>\n"
      "</build>\n</model>\n");
  text.flush();
  file.commit();
}

}  // namespace voxdag
