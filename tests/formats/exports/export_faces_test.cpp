// Meshes of outer faces against the faces themselves. GLB and OBJ have their own readers here.
#include "voxdag/formats/exports/faces/export_faces.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <sstream>

#include "colored_scene.hpp"
#include "read_back.hpp"
#include "support/error_of.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/core/srgb.hpp"
#include "voxdag/core/vec2.hpp"
#include "voxdag/formats/exports/export_ply.hpp"
#include "voxdag/formats/exports/faces/manifold_faces.hpp"
#include "voxdag/formats/exports/faces/rectangles.hpp"
#include "voxdag/formats/readers/mesh_chunks.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/image/decode.hpp"

namespace voxdag {
namespace {

/// A triangle or quad: corners in voxel coordinates, and a colour (0 to 65535, linear).
struct Polygon {
  std::vector<Vec3d> corners;
  Vec3i color{};
};

/// Returns all polygons' areas by the place of the plane and its direction, and checks that the
/// polygons agree with the rectangles of the scene.
using PlaneAreas = std::map<std::tuple<int, int, int>, double>;

PlaneAreas areas_of(const std::vector<Polygon>& polygons) {
  PlaneAreas areas;
  for (const Polygon& p : polygons) {
    Vec3d normal{};
    for (std::size_t i = 1; i + 1 < p.corners.size(); ++i)
      normal = normal + cross(p.corners[i] - p.corners[0], p.corners[i + 1] - p.corners[0]) * 0.5;
    for (int axis = 0; axis < 3; ++axis)
      if (normal[axis] != 0)
        areas[{axis, normal[axis] > 0 ? 1 : -1,
               static_cast<int>(std::lround(p.corners[0][axis]))}] += std::abs(normal[axis]);
  }
  return areas;
}

PlaneAreas areas_of(const VoxelSet& voxels, const Box3i& window) {
  PlaneAreas areas;
  for_each_rectangle(voxels, window, nullptr, false, nullptr, [&](const FaceRectangle& r) {
    areas[{face_axis(r.face), dot(face_normal(r.face), Vec3i{1, 1, 1}), r.lo[face_axis(r.face)]}] +=
        1;
  });
  return areas;
}

template <class T>
T read_at(const std::string& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

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
  std::vector<Polygon> triangles() const {
    std::vector<Polygon> result;
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
std::vector<Polygon> in_grid(std::vector<Polygon> polygons, const Grid& grid) {
  for (Polygon& polygon : polygons)
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
  for (const Polygon& t : in_grid(Glb(read_text(dir / "v.glb")).triangles(), scene.grid))
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

std::vector<Polygon> read_obj(const std::string& text, const Grid& grid) {
  std::vector<Polygon> polygons;
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
      Polygon polygon;
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
  const std::vector<Polygon> triangles = read_obj(read_text(dir / "v.obj"), scene.grid);
  EXPECT_EQ(areas_of(triangles), areas_of(scene.view(), *options.window));
  std::set<std::array<int, 3>> colors, expected;
  for (const Polygon& t : triangles) {
    EXPECT_EQ(t.corners.size(), 3u);
    colors.insert({t.color.x, t.color.y, t.color.z});
  }
  for (const Vec3i v : scene.voxels) {
    const Value8 color = scene.value(v);
    expected.insert({color.x, color.y, color.z});
  }
  for (const auto& color : colors) EXPECT_TRUE(expected.contains(color));
}

TEST(ExportStl, TheMeshIsClosed) {
  const TempDir dir;
  const ExportedScene scene(5, 3000);
  export_stl(dir / "v.stl", scene.view(), scene.grid);
  const std::string bytes = read_text(dir / "v.stl");
  const auto count = read_at<std::uint32_t>(bytes, 80);
  ASSERT_EQ(bytes.size(), 84 + std::size_t{50} * count);
  EXPECT_FALSE(bytes.starts_with("solid"));
  std::vector<Polygon> triangles;
  using Corner = std::array<float, 3>;
  std::map<std::pair<Corner, Corner>, int> edges;
  for (std::size_t i = 0; i < count; ++i) {
    Polygon triangle;
    std::array<Corner, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto p = read_at<Vec3f>(bytes, 84 + 50 * i + 12 * (c + 1));
      corners[c] = {p.x, p.y, p.z};
      triangle.corners.push_back((Vec3d(p) - scene.grid.origin) * 4.0);
    }
    for (std::size_t c = 0; c < 3; ++c) {
      ++edges[{corners[c], corners[(c + 1) % 3]}];
      --edges[{corners[(c + 1) % 3], corners[c]}];
    }
    const Vec3d normal =
        cross(triangle.corners[1] - triangle.corners[0], triangle.corners[2] - triangle.corners[0]);
    EXPECT_EQ(Vec3f(normal), read_at<Vec3f>(bytes, 84 + 50 * i));
    triangles.push_back(triangle);
  }
  for (const auto& [edge, balance] : edges) EXPECT_EQ(balance, 0);
  EXPECT_EQ(areas_of(triangles), areas_of(scene.view(), whole_grid(5)));
}

TEST(ExportStl, SmoothTrianglesHaveNormalsOfTheirOwn) {
  const TempDir dir;
  const ExportedScene scene(5, 3000);
  ExportOptions options;
  options.faces = FaceMesh::kSmooth;
  export_stl(dir / "v.stl", scene.view(), scene.grid, options);
  const std::string bytes = read_text(dir / "v.stl");
  std::map<std::pair<std::array<float, 3>, std::array<float, 3>>, int> edges;
  for (std::size_t at = 84; at < bytes.size(); at += 50) {
    const auto corners = read_at<std::array<Vec3f, 3>>(bytes, at + 12);
    const Vec3d normal =
        cross(Vec3d(corners[1]) - Vec3d(corners[0]), Vec3d(corners[2]) - Vec3d(corners[0]));
    // Coordinates are rounded to 2^-19 of a voxel.
    EXPECT_LT(length(normalized(normal) - Vec3d(read_at<Vec3f>(bytes, at))), 1e-4);
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3f a = corners[c], b = corners[(c + 1) % 3];
      ++edges[{{a.x, a.y, a.z}, {b.x, b.y, b.z}}];
      --edges[{{b.x, b.y, b.z}, {a.x, a.y, a.z}}];
    }
  }
  for (const auto& [edge, balance] : edges) EXPECT_EQ(balance, 0);
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

/// Returns the triangles of an STL file, as written.
std::vector<std::array<Vec3f, 3>> stl_triangles(const std::string& bytes) {
  std::vector<std::array<Vec3f, 3>> triangles(read_at<std::uint32_t>(bytes, 80));
  for (std::size_t i = 0; i < triangles.size(); ++i)
    triangles[i] = read_at<std::array<Vec3f, 3>>(bytes, 84 + 50 * i + 12);
  return triangles;
}

TEST(ExportStl, AFarGridHasALocalOriginAndTheOffsetIsSaid) {
  const TempDir dir;
  ExportedScene scene(6, 100);
  std::vector<std::string> notes;
  ExportOptions options;
  options.notes = &notes;
  options.window = kWindow;
  scene.grid.origin = {0, 0, 0};
  export_stl(dir / "near.stl", scene.view(), scene.grid, options);
  EXPECT_TRUE(notes.empty());
  EXPECT_EQ(dir.count(), 1);
  scene.grid.origin.x = 1e6;
  export_stl(dir / "far.stl", scene.view(), scene.grid, options);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("offset 1000000.75 0.25 1.5"), std::string::npos) << notes[0];
  EXPECT_EQ(placement_of(dir / "far.stl")["offset"], nlohmann::json({1000000.75, 0.25, 1.5}));
  const auto near = stl_triangles(read_text(dir / "near.stl"));
  const auto far = stl_triangles(read_text(dir / "far.stl"));
  ASSERT_EQ(near.size(), far.size());
  for (std::size_t i = 0; i < near.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_EQ(far[i][c] + Vec3f(0.75f, 0.25f, 1.5f), near[i][c]);
  // The reader adds the offset.
  EXPECT_EQ(read_mesh(dir / "near.stl").origin, (Vec3d{}));
  EXPECT_EQ(read_mesh(dir / "far.stl").origin, (Vec3d{1000000.75, 0.25, 1.5}));
  EXPECT_EQ(open_mesh_chunks(dir / "far.stl", {}, 1 << 20), nullptr);
  EXPECT_NE(open_mesh_chunks(dir / "near.stl", {}, 1 << 20), nullptr);
  // Another export of this name needs no offset.
  std::filesystem::rename(dir / "far.stl.json", dir / "near.stl.json");
  scene.grid.origin.x = 0;
  export_stl(dir / "near.stl", scene.view(), scene.grid, options);
  EXPECT_FALSE(std::filesystem::exists(dir / "near.stl.json"));
  // Voxels that are too small for floats are refused.
  scene.grid.voxel_size = 1e-300;
  EXPECT_NE(error_of([&] {
              export_stl(dir / "small.stl", scene.view(), scene.grid);
            }).find("cannot hold voxels of this size"),
            std::string::npos);
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
