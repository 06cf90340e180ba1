/// Tests meshes that are far from 0, and vertices that are not finite, in every format.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "formats/readers/appearance_files.hpp"
#include "formats/readers/mesh_text.hpp"
#include "support/error_of.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/float_origin.hpp"

namespace voxdag {
namespace {

using Points = std::vector<Vec3d>;

const Points kCorners = {{0.1, 0.2, 0.3}, {0.47, 0.2, 0.3}, {0.47, 0.43, 0.3}, {0.1, 0.2, 0.66}};
constexpr int kFaces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};

std::string text_of(Vec3d p) { return fmt::format("{} {} {}", p.x, p.y, p.z); }

/// A format: its extension, and a writer of the faces with the given corners. Binary formats of
/// float32 cannot hold points far from 0.
struct Format {
  const char* name;
  std::function<std::string(const Points&)> write;
};

std::string ply(const Points& points, const char* format) {
  std::string text = fmt::format(
      "ply\nformat {} 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty "
      "double "
      "z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n",
      format, points.size());
  const bool is_text = std::string_view(format) == "ascii";
  for (const Vec3d p : points) {
    if (is_text) text += text_of(p) + "\n";
    for (int axis = 0; axis < 3 && !is_text; ++axis) append(text, p[axis]);
  }
  for (const auto& face : kFaces) {
    if (is_text) text += fmt::format("3 {} {} {}\n", face[0], face[1], face[2]);
    if (!is_text) append(text, std::uint8_t{3});
    for (int c = 0; c < 3 && !is_text; ++c) append(text, std::int32_t{face[c]});
  }
  return text;
}

const Format kFormats[] = {
    {"a.obj",
     [](const Points& points) {
       std::string text;
       for (const Vec3d p : points) text += "v " + text_of(p) + "\n";
       for (const auto& f : kFaces)
         text += fmt::format("f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1);
       return text;
     }},
    {"text.ply", [](const Points& points) { return ply(points, "ascii"); }},
    {"binary.ply", [](const Points& points) { return ply(points, "binary_little_endian"); }},
    {"a.stl",
     [](const Points& points) {
       std::string text = "solid\n";
       for (const auto& f : kFaces) {
         text += "facet normal 0 0 0 outer loop\n";
         for (const int c : f)
           text += "vertex " + text_of(points[static_cast<std::size_t>(c)]) + "\n";
         text += "endloop endfacet\n";
       }
       return text + "endsolid\n";
     }},
    {"a.dae",
     [](const Points& points) {
       std::string text, corners;
       for (const Vec3d p : points) text += text_of(p) + " ";
       for (const auto& f : kFaces) corners += fmt::format("{} {} {} ", f[0], f[1], f[2]);
       return "<COLLADA><library_geometries><geometry id='g'><mesh><source id='p'><float_array "
              "id='f'>" +
              text +
              "</float_array><technique_common><accessor source='#f' count='4' stride='3'/>"
              "</technique_common></source><vertices id='v'><input semantic='POSITION' "
              "source='#p'/></vertices><triangles><input semantic='VERTEX' source='#v' "
              "offset='0'/><p>" +
              corners +
              "</p></triangles></mesh></geometry></library_geometries><library_visual_scenes>"
              "<visual_scene id='s'><node><instance_geometry url='#g'/></node></visual_scene>"
              "</library_visual_scenes><scene><instance_visual_scene url='#s'/></scene></COLLADA>";
     }},
    {"a.off", [](const Points& points) {
       std::string text = fmt::format("OFF {} 4 0\n", points.size());
       for (const Vec3d p : points) text += text_of(p) + "\n";
       for (const auto& f : kFaces) text += fmt::format("3 {} {} {}\n", f[0], f[1], f[2]);
       return text;
     }}};

/// Returns the corners, moved.
Points corners_at(Vec3d place) {
  Points points;
  for (const Vec3d p : kCorners) points.push_back(p + place);
  return points;
}

constexpr Vec3d kFarPlace{500'000, 4'649'776, 100};

class FarMesh : public ReadAppearance {
 protected:
  Mesh mesh_of(const Format& format, const Points& points) {
    return read_mesh(write(format.name, format.write(points)));
  }
};

TEST_F(FarMesh, VerticesAreMeasuredFromAnOriginBeforeTheyAreRounded) {
  for (const Format& format : kFormats) {
    const Points points = corners_at(kFarPlace);
    const Mesh mesh = mesh_of(format, points);
    EXPECT_EQ(mesh.origin, (Vec3d{500'000.09375, 4'649'776, 100.300003051757812})) << format.name;
    for (const Triangle& triangle : mesh.triangles)
      for (const std::uint32_t vertex : triangle) {
        double least = 1;
        for (const Vec3d p : points) least = std::min(least, length(p - mesh.position(vertex)));
        EXPECT_LT(least, 3e-8) << format.name;  // Half a unit of float32 below 0.5, three axes.
      }
    const Box3d bounds{kFarPlace, kFarPlace + Vec3d{1, 1, 1}};
    const Mesh near = mesh_of(format, kCorners);
    EXPECT_EQ(build_svdag(mesh, grid_from_bounds(bounds, 6)).dag,
              build_svdag(near, grid_from_bounds(Box3d{{}, {1, 1, 1}}, 6)).dag)
        << format.name;
  }
}

TEST_F(FarMesh, MeshesNearZeroKeepTheNearestFloats) {
  for (const Format& format : kFormats)
    for (const Vec3d place : {Vec3d{}, Vec3d{5, -5, 0}}) {
      const Mesh mesh = mesh_of(format, corners_at(place));
      EXPECT_EQ(mesh.origin, Vec3d{}) << format.name;
      EXPECT_EQ(mesh.vertices[0], static_cast<Vec3f>(kCorners[0] + place)) << format.name;
    }
}

TEST_F(FarMesh, AnOriginIsChosenAlongEachAxisAlone) {
  const Box3d box{{-34, -1, 15.75}, {-33, 0, 16.5}};
  EXPECT_EQ(float_origin(box), (Vec3d{-34, 0, 0}));
  EXPECT_EQ(float_origin({{0, 0, 16.25}, {0, 1, 16.5}}), (Vec3d{0, 0, 16.25}));
  EXPECT_EQ(float_origin(Box3d::empty()), Vec3d{});
}

TEST_F(FarMesh, UnusedVerticesDoNotKeepAMeshNear) {
  std::string text = kFormats[0].write(corners_at(kFarPlace)) + "v 0 0 0\n";
  EXPECT_EQ(read_mesh(write("a.obj", text)).origin.y, 4'649'776);
}

TEST_F(FarMesh, GltfNodesAreTransformedInDouble) {
  std::string buffer;
  for (const float x : {0.1f, 0.2f, 0.3f, 0.47f, 0.2f, 0.3f, 0.1f, 0.4f, 0.3f}) append(buffer, x);
  write("b.bin", buffer);
  const auto path = write("a.gltf", R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],
    "nodes":[{"mesh":0,"translation":[500000.1,4649776,100]}],"buffers":[{"uri":"b.bin",
    "byteLength":36}],"bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,
    "componentType":5126,"count":3,"type":"VEC3"}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]})");
  const Mesh mesh = read_mesh(path);
  EXPECT_NEAR(mesh.position(1).x, 500'000.57, 1e-7);
  EXPECT_NEAR(mesh.position(2).y, 4'649'776.4, 1e-7);
}

TEST_F(FarMesh, TrianglesWithAVertexThatIsNotFiniteAreLeftOutAndCounted) {
  for (const Format& format : kFormats)
    for (const double bad : {std::nan(""), HUGE_VAL, 1e39}) {
      Points points = kCorners;
      points[2].y = bad;
      const auto read = read_mesh_with_appearance(write(format.name, format.write(points)));
      EXPECT_EQ(read.mesh.triangles.size(), 1u) << format.name;
      EXPECT_EQ(read.warnings,
                std::vector{path(format.name) + ": 3 triangles left out: a vertex is not finite"});
      std::vector<std::string> warnings;
      read_mesh(path(format.name), {.warnings = &warnings});
      EXPECT_EQ(warnings, read.warnings);
      points[0].z = bad;
      write(format.name, format.write(points));
      EXPECT_EQ(error_of([&] { read_mesh(path(format.name)); }),
                path(format.name) + ": every triangle has a vertex that is not finite");
    }
}

TEST_F(FarMesh, NumbersThatAreNotFiniteMayBeWrittenByWindows) {
  for (const char* number : {"-1.#IND", "1.#QNAN", "1.#INF", "-1.#INF00", "1.#SNAN0"}) {
    for (const Format& format : kFormats) {
      if (format.name == std::string("binary.ply")) continue;
      Points points = kCorners;
      points[2].y = 77;
      std::string text = format.write(points);
      for (std::size_t at = 0; (at = text.find("77", at)) != text.npos;)
        text.replace(at, 2, number);
      const auto read = read_mesh_with_appearance(write(format.name, text));
      EXPECT_EQ(read.mesh.triangles.size(), 1u) << format.name;
      EXPECT_EQ(read.warnings,
                std::vector{path(format.name) + ": 3 triangles left out: a vertex is not finite"});
    }
  }
  for (const char* word : {"1.#", "1.#QN", "2.#INF", "1#INF", "1.#INFx", "x1.#IND"}) {
    const std::string text = "v 0 0 " + std::string(word) + "\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    EXPECT_EQ(error_of([&] { read_mesh(write("a.obj", text)); }),
              path("a.obj") + ": line 1: coordinate '" + word + "' is not a number");
  }
}

TEST_F(FarMesh, LeftOutTrianglesTakeTheirCornersAlong) {
  const auto result = read_mesh_with_appearance(write(
      "a.obj", kSquare + "v nan 0 0\nvt 0 0\nvt 1 1\nvn 0 0 1\nusemtl a\nf 1/1/1 2/1/1 5/1/1\n"
                         "usemtl b\nf 1/2/1 2/2/1 3/2/1\n"));
  EXPECT_EQ(result.mesh.triangles, (StoredVector<Triangle>{{0, 1, 2}}));
  EXPECT_EQ(result.mesh.triangle_materials, (StoredVector<std::uint32_t>{1}));
  EXPECT_EQ(result.appearance.uvs, std::vector<Vec2f>(3, {1, 0}));
  EXPECT_EQ(result.appearance.normals.size(), 3u);
}

}  // namespace
}  // namespace voxdag
