// Meshes of outer faces against the faces themselves. GLB and OBJ have their own readers here.
#include "voxdag/formats/exports/faces/export_faces.hpp"

#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "colored_scene.hpp"
#include "face_areas.hpp"
#include "read_back.hpp"
#include "support/error_of.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/core/srgb.hpp"
#include "voxdag/core/vec2.hpp"
#include "voxdag/formats/exports/export_ply.hpp"
#include "voxdag/formats/exports/faces/manifold_faces.hpp"
#include "voxdag/formats/exports/faces/rectangles.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/image/decode.hpp"

namespace voxdag {
namespace {

struct Glb {
  nlohmann::json json;
  std::string data;
  mutable Vec3d lo{1e9, 1e9, 1e9}, hi{-1e9, -1e9, -1e9};  ///< Bounds of triangles().

  explicit Glb(const std::string& bytes) {
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(read_at<std::uint32_t>(bytes, 4), 2u);
    EXPECT_EQ(read_at<std::uint32_t>(bytes, 8), bytes.size());
    const auto json_bytes = read_at<std::uint32_t>(bytes, 12);
    EXPECT_EQ(bytes.substr(16, 4), "JSON");
    EXPECT_EQ(json_bytes % 4, 0u);
    json = nlohmann::json::parse(bytes.substr(20, json_bytes));
    if (bytes.size() == 20 + json_bytes) return;
    EXPECT_EQ(bytes.substr(24 + json_bytes, 4), std::string("BIN\0", 4));
    data = bytes.substr(28 + json_bytes);
    EXPECT_EQ(data.size(), read_at<std::uint32_t>(bytes, 20 + json_bytes));
    EXPECT_EQ(data.size(), json["buffers"][0]["byteLength"].get<std::size_t>());
  }
  std::size_t place(std::size_t accessor, std::size_t i, std::size_t size) const {
    const auto& a = json["accessors"][accessor];
    const auto& view = json["bufferViews"][a["bufferView"].get<std::size_t>()];
    return view.value("byteOffset", std::size_t{0}) + a.value("byteOffset", std::size_t{0}) +
           i * view.value("byteStride", size);
  }
  /// Returns the triangles with coordinates in the world.
  std::vector<ReadPolygon> triangles() const {
    std::vector<ReadPolygon> result;
    const auto& node = json["nodes"][0];
    Vec3d scale{1, 1, 1}, translation{};
    for (int axis = 0; axis < 3 && node.contains("scale"); ++axis) {
      scale[axis] = node["scale"][static_cast<std::size_t>(axis)];
      translation[axis] = node["translation"][static_cast<std::size_t>(axis)];
    }
    const auto count = json["accessors"][1]["count"].get<std::size_t>();
    for (std::size_t i = 0; i < count; ++i) {
      if (i % 3 == 0) result.emplace_back();
      const auto index = read_at<std::uint32_t>(data, place(1, i, 4));
      const Vec3d corner(read_at<Vec3f>(data, place(0, index, 12)));
      lo = min(lo, corner);
      hi = max(hi, corner);
      result.back().corners.push_back({corner.x * scale.x + translation.x,
                                       corner.y * scale.y + translation.y,
                                       corner.z * scale.z + translation.z});
      if (json["accessors"].size() > 2) {
        const auto color = read_at<std::array<std::uint16_t, 4>>(data, place(2, index, 8));
        EXPECT_EQ(color[3], 65535);
        result.back().color = {color[0], color[1], color[2]};
      }
    }
    return result;
  }
};

/// Changes coordinates to voxels of the grid.
std::vector<ReadPolygon> in_grid(std::vector<ReadPolygon> polygons, const Grid& grid) {
  for (ReadPolygon& polygon : polygons)
    for (Vec3d& corner : polygon.corners) corner = (corner - grid.origin) * (1 / grid.voxel_size);
  return polygons;
}

TEST(ExportGlb, TrianglesAreTheOuterFacesInTheWorld) {
  const TempDir dir;
  ExportedScene scene(5, 2000);
  for (const double origin : {10.0, 1e6})
    for (const Box3i& window : {whole_grid(5), Box3i{{3, 1, 6}, {29, 32, 13}}}) {
      scene.grid.origin.x = origin;
      export_glb(dir / "v.glb", scene.view(), scene.grid, windowed(window.lo, window.hi));
      const Glb glb(read_text(dir / "v.glb"));
      EXPECT_EQ(areas_of(in_grid(glb.triangles(), scene.grid)), areas_of(scene.view(), window));
      // Far from the origin, floats cannot tell sixteenths of a voxel.
      EXPECT_EQ(glb.json["nodes"][0].contains("scale"), origin == 1e6);
      const auto& places = glb.json["accessors"][0];
      EXPECT_EQ(places["min"], nlohmann::json({glb.lo.x, glb.lo.y, glb.lo.z}));
      EXPECT_EQ(places["max"], nlohmann::json({glb.hi.x, glb.hi.y, glb.hi.z}));
    }
  EXPECT_EQ(dir.count(), 1);
}

TEST(ExportGlb, ColorsAreThoseOfTheVoxelsInLinearLight) {
  const TempDir dir;
  const ColoredScene scene(6);
  export_glb(dir / "v.glb", scene.view(), scene.grid, scene.options);
  std::map<std::array<int, 3>, double> found, expected;
  for (const ReadPolygon& t : in_grid(Glb(read_text(dir / "v.glb")).triangles(), scene.grid))
    found[{t.color.x, t.color.y, t.color.z}] +=
        length(cross(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0])) / 2;
  for_each_rectangle(scene.view(), whole_grid(6), nullptr, false, nullptr,
                     [&](const FaceRectangle& r) {
                       Vec3i voxel = r.lo;
                       if ((static_cast<int>(r.face) & 1) != 0) --voxel[face_axis(r.face)];
                       const Value8 color = scene.value(voxel);
                       const auto linear = [](std::uint8_t c) {
                         return static_cast<int>(std::lround(srgb_to_linear(c / 255.0f) * 65535));
                       };
                       expected[{linear(color.x), linear(color.y), linear(color.z)}] += 1;
                     });
  EXPECT_EQ(found, expected);
}

TEST(ExportGlb, AnEmptySceneHasNoMesh) {
  const TempDir dir;
  const ExportedScene scene(4, 0);
  export_glb(dir / "v.glb", scene.view(), scene.grid);
  const Glb glb(read_text(dir / "v.glb"));
  EXPECT_FALSE(glb.json.contains("meshes"));
  EXPECT_TRUE(glb.data.empty());
}

std::vector<ReadPolygon> read_obj(const std::string& text, const Grid& grid) {
  std::vector<ReadPolygon> polygons;
  std::vector<std::pair<Vec3d, Vec3d>> corners;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      Vec3d p, color{};
      words >> p.x >> p.y >> p.z >> color.x >> color.y >> color.z;
      corners.emplace_back((p - grid.origin) * (1 / grid.voxel_size), color);
    } else if (kind == "f") {
      ReadPolygon polygon;
      for (std::size_t index = 0; words >> index;) {
        const auto& [place, color] = corners.at(index - 1);
        polygon.corners.push_back(place);
        for (int i = 0; i < 3; ++i)
          polygon.color[i] = static_cast<int>(std::lround(color[i] * 255));
      }
      polygons.push_back(polygon);
    }
  }
  return polygons;
}

TEST(ExportObj, TrianglesAreTheOuterFacesInTheWorld) {
  const TempDir dir;
  const ColoredScene scene(6);
  ExportOptions options = scene.options;
  options.window = Box3i{{3, 1, 6}, {64, 62, 33}};
  export_obj(dir / "v.obj", scene.view(), scene.grid, options);
  const std::vector<ReadPolygon> triangles = read_obj(read_text(dir / "v.obj"), scene.grid);
  EXPECT_EQ(areas_of(triangles), areas_of(scene.view(), *options.window));
  std::set<std::array<int, 3>> colors, expected;
  for (const ReadPolygon& t : triangles) {
    EXPECT_EQ(t.corners.size(), 3u);
    colors.insert({t.color.x, t.color.y, t.color.z});
  }
  for (const Vec3i v : scene.voxels) {
    const Value8 color = scene.value(v);
    expected.insert({color.x, color.y, color.z});
  }
  for (const auto& color : colors) EXPECT_TRUE(expected.contains(color));
}

TEST(FaceMeshes, SmoothFilesHaveTheSameSurface) {
  const TempDir dir;
  const ExportedScene scene(5, 3000);
  ExportOptions options;
  options.faces = FaceMesh::kSmooth;
  export_stl(dir / "v.stl", scene.view(), scene.grid, options);
  export_obj(dir / "v.obj", scene.view(), scene.grid, options);
  export_glb(dir / "v.glb", scene.view(), scene.grid, options);
  export_ply_faces(dir / "v.ply", scene.view(), scene.grid, options);
  export_3mf(dir / "v.3mf", scene.view(), scene.grid, options);
  const Mesh stl = read_mesh(dir / "v.stl"), obj = read_mesh(dir / "v.obj");
  for (const char* name : {"v.obj", "v.glb", "v.ply", "v.3mf"}) {
    const Mesh mesh = read_mesh(dir / name);
    EXPECT_EQ(mesh.vertices.size(), obj.vertices.size()) << name;  // They are shared.
    ASSERT_EQ(mesh.triangles.size(), stl.triangles.size()) << name;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_EQ(mesh.vertices[mesh.triangles[i][c]], stl.vertices[stl.triangles[i][c]]);
  }
}

TEST(FaceMeshes, ATextureHasTheColorsOfTheVoxels) {
  const TempDir dir;
  const ColoredScene scene(6);
  ExportOptions options = scene.options;
  options.texture = true;
  export_glb(dir / "v.glb", scene.view(), scene.grid, options);
  export_obj(dir / "v.obj", scene.view(), scene.grid, options);
  EXPECT_EQ(dir.count(), 4);
  std::map<std::array<int, 3>, double> expected, in_glb, in_obj;
  for_each_rectangle(scene.view(), whole_grid(6), nullptr, false, nullptr,
                     [&](const FaceRectangle& r) {
                       Vec3i voxel = r.lo;
                       if ((static_cast<int>(r.face) & 1) != 0) --voxel[face_axis(r.face)];
                       const Value8 color = scene.value(voxel);
                       expected[{color.x, color.y, color.z}] += 1;
                     });
  const DecodedImage image = read_image(dir / "v.png");
  const auto color_at = [&](double u, double v) {  // v points down.
    const auto rgba =
        image.pixel(static_cast<int>(u * image.width()), static_cast<int>(v * image.height()));
    return std::array<int, 3>{rgba[0] / 257, rgba[1] / 257, rgba[2] / 257};
  };
  const Glb glb(read_text(dir / "v.glb"));
  const auto& view = glb.json["bufferViews"][2];
  std::string png = read_text(dir / "v.png");
  EXPECT_EQ(glb.data.substr(view["byteOffset"], png.size()), png);
  const auto count = glb.json["accessors"][1]["count"].get<std::size_t>();
  for (std::size_t i = 0; i < count; i += 3) {
    std::array<Vec3d, 3> p;
    Vec2f uv;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto index = read_at<std::uint32_t>(glb.data, glb.place(1, i + c, 4));
      p[c] = Vec3d(read_at<Vec3f>(glb.data, glb.place(0, index, 12)));
      uv = read_at<Vec2f>(glb.data, glb.place(2, index, 8));
    }
    const double side = scene.grid.voxel_size;
    in_glb[color_at(uv.x, uv.y)] += length(cross(p[1] - p[0], p[2] - p[0])) / (2 * side * side);
  }
  EXPECT_EQ(in_glb, expected);
  std::vector<Vec3d> places;
  std::vector<std::array<int, 3>> colors;
  std::istringstream lines(read_text(dir / "v.obj"));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    double x = 0, y = 0, z = 0;
    if (kind == "v") {
      words >> x >> y >> z;
      places.push_back({x, y, z});
    } else if (kind == "vt") {
      words >> x >> y;
      colors.push_back(color_at(x, 1 - y));
    } else if (kind == "f") {
      std::array<Vec3d, 3> p;
      std::size_t corner = 0, uv = 0;
      for (char slash = 0; Vec3d & q : p) {
        words >> corner >> slash >> uv;
        q = places.at(corner - 1);
      }
      const double side = scene.grid.voxel_size;
      in_obj[colors.at(uv - 1)] += length(cross(p[1] - p[0], p[2] - p[0])) / (2 * side * side);
    }
  }
  EXPECT_EQ(in_obj, expected);
  EXPECT_EQ(read_text(dir / "v.mtl"), "newmtl voxels\nKd 1 1 1\nmap_Kd v.png\n");
}

}  // namespace
}  // namespace voxdag
