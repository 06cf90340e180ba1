#include <array>
#include <cmath>
#include <string>

#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/formats/exports/coordinates.hpp"
#include "voxdag/formats/exports/faces/export_faces.hpp"
#include "voxdag/formats/exports/faces/exported_polygons.hpp"
#include "voxdag/image/png.hpp"

namespace voxdag {
namespace {

template <class T>
void append(std::string& line, const Vec3<T>& v) {
  for (int axis = 0; axis < 3; ++axis) line.append(" ").append(shortest(v[axis]));
}

/// Returns the texts of the colours 0 to 255: from 0 to 1, with as many digits as tell them apart.
std::array<std::string, 256> channel_texts() {
  std::array<std::string, 256> texts;
  for (std::size_t i = 0; i < texts.size(); ++i)
    texts[i] = shortest(static_cast<float>(std::round(static_cast<double>(i) / 255 * 1e4) / 1e4));
  return texts;
}

}  // namespace

void export_obj(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                const ExportOptions& options) {
  const Box3i window = export_window(path, voxels, options);
  ExportedPolygons polygons(voxels, window, options, PolygonFormat::kVertexColors);
  std::filesystem::path material = path, image = path;
  material.replace_extension(".mtl");
  image.replace_extension(".png");
  ColorTexture texture;
  if (polygons.has_texture()) {
    texture = polygons.measure().texture;
    write_png(image, texture.image());
    write_whole_file(material,
                     "newmtl voxels\nKd 1 1 1\nmap_Kd " + image.filename().string() + "\n");
  }
  AtomicFile file(path);
  std::string text = "# made by voxdag\n# grid_origin";
  append(text, grid.origin);
  text.append("\n# voxel_size ").append(shortest(grid.voxel_size));
  text.append("\n# resolution ").append(std::to_string(grid.resolution())).append("\n");
  if (polygons.has_texture())
    text.append("mtllib ").append(material.filename().string()).append("\nusemtl voxels\n");
  file.write(text);
  const bool use_float = float_suffices(grid);
  const std::array<std::string, 256> channels = channel_texts();
  std::uint64_t uv = 0;
  polygons.for_each([&](const FacePolygon& polygon, const SharedVertices& vertices) {
    text.clear();
    const Value8 color = polygon.color;
    for (const Vec3d place : vertices.added()) {
      text.append("v");
      const Vec3d world = grid.to_world(place);
      if (use_float)
        append(text, Vec3f(world));
      else
        append(text, world);
      if (polygons.has_colors() && !polygons.has_texture())
        for (const std::uint8_t channel : {color.x, color.y, color.z})
          text.append(" ").append(channels[channel]);
      text.append("\n");
    }
    if (polygons.has_texture()) {
      const Vec2f at = texture.uv(color);  // v points up in OBJ files.
      text.append("vt ").append(shortest(at.x)).append(" ").append(shortest(1 - at.y)).append("\n");
      ++uv;
    }
    // Some readers skip quads.
    for (const std::array<std::uint32_t, 3>& triangle : polygon.triangles) {
      text.append("f");
      for (const std::uint32_t i : triangle) {
        text.append(" ").append(std::to_string(vertices.numbers()[i] + 1));
        if (uv > 0) text.append("/").append(std::to_string(uv));
      }
      text.append("\n");
    }
    file.write(text);
  });
  file.commit();
}

}  // namespace voxdag
