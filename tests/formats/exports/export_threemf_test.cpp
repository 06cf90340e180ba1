// 3MF files: what read_3mf() reads is what the manifold has, and the archive is as the standard
// says.
#include <gtest/gtest.h>

#include <map>

#include "colored_scene.hpp"
#include "read_back.hpp"
#include "support/error_of.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/core/srgb.hpp"
#include "voxdag/formats/exports/faces/export_faces.hpp"
#include "voxdag/formats/exports/faces/manifold_faces.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/mesh/appearance.hpp"

namespace voxdag {
namespace {

TEST(Export3mf, IsReadBackAsTheManifoldWithSharedVertices) {
  const TempDir dir;
  const ExportedScene scene(6, 13000);
  for (const bool smooth : {false, true}) {
    ExportOptions options;
    if (smooth) options.faces = FaceMesh::kSmooth;
    std::uint64_t triangles = 0;
    options.faces_written = &triangles;
    export_3mf(dir / "v.3mf", scene.view(), scene.grid, options);
    const Mesh mesh = read_mesh(dir / "v.3mf");
    ASSERT_EQ(mesh.triangles.size(), triangles);
    EXPECT_GT(triangles, 65535u);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    std::size_t at = 0;
    for_each_manifold_face(
        scene.view(), whole_grid(6), nullptr, [](std::uint64_t) {},
        [&](const FacePolygon& polygon) {
          for (const auto& triangle : polygon.triangles) {
            const Triangle& read = mesh.triangles[at++];
            for (std::size_t c = 0; c < 3; ++c) {
              EXPECT_EQ(mesh.vertices[read[c]],
                        Vec3f(scene.grid.to_world(polygon.corners[triangle[c]])));
              ++edges[{read[c], read[(c + 1) % 3]}];
            }
          }
        },
        smooth);
    for (const auto& [edge, count] : edges) {
      EXPECT_EQ(count, 1);
      EXPECT_TRUE(edges.contains({edge.second, edge.first}));
    }
  }
  EXPECT_EQ(dir.count(), 1);
}

TEST(Export3mf, TrianglesHaveTheColorsOfTheirVoxels) {
  const TempDir dir;
  const ColoredScene scene(6);
  export_3mf(dir / "v.3mf", scene.view(), scene.grid, scene.options);
  const MeshWithAppearance read = read_mesh_with_appearance(dir / "v.3mf");
  EXPECT_TRUE(read.warnings.empty());
  std::size_t at = 0;
  for_each_manifold_face(
      scene.view(), whole_grid(6), nullptr, [](std::uint64_t) {},
      [&](const FacePolygon& polygon) {
        const Value8 color = scene.value(polygon.voxel);
        for (std::size_t i = 0; i < polygon.triangles.size(); ++i, ++at) {
          const Material& material = read.appearance.materials[read.mesh.triangle_materials[at]];
          EXPECT_EQ(material.base_color,
                    (Vec3f{srgb_to_linear(static_cast<float>(color.x) / 255),
                           srgb_to_linear(static_cast<float>(color.y) / 255),
                           srgb_to_linear(static_cast<float>(color.z) / 255)}));
        }
      });
  EXPECT_EQ(at, read.mesh.triangles.size());
}

TEST(Export3mf, HasTheUnitOfTheScene) {
  const TempDir dir;
  const Svdag dag = brute_svdag(2, {{1, 1, 1}});
  Grid grid;
  grid.levels = 2;
  grid.voxel_size = 1;
  for (const auto& [unit, size] : std::map<std::string, float>{
           {"", 1}, {"mm", 1}, {"cm", 10}, {"m", 1000}, {"in", 25.4f}, {"ft", 304.8f}}) {
    ExportOptions options;
    options.unit = unit;
    export_3mf(dir / "v.3mf", dag.view(), grid, options);
    const Mesh mesh = read_mesh(dir / "v.3mf");
    EXPECT_EQ(mesh.vertices.size(), 8u);
    EXPECT_EQ(mesh.vertices[0], (Vec3f{size, size, size})) << unit;
  }
}

TEST(Export3mf, EqualVoxelsGiveEqualBytesWithoutATime) {
  const TempDir dir;
  const ExportedScene scene(5, 300);
  export_3mf(dir / "v.3mf", scene.view(), scene.grid);
  const std::string bytes = read_text(dir / "v.3mf");
  EXPECT_EQ(bytes.substr(0, 4), "PK\x03\x04");
  EXPECT_EQ(bytes.substr(10, 4), std::string("\0\0\x21\0", 4));  // 00:00 on 1980-01-01
  EXPECT_EQ(bytes.substr(30, 19), "[Content_Types].xml");
  for (const char* part : {"_rels/.rels", "3D/3dmodel.model"})
    EXPECT_NE(bytes.find(part), std::string::npos);
}

TEST(Export3mf, RefusesASceneWithoutVoxels) {
  const TempDir dir;
  const ExportedScene scene(4, 0);
  EXPECT_EQ(error_of([&] { export_3mf(dir / "v.3mf", scene.view(), scene.grid); }),
            (dir / "v.3mf").string() + ": a 3MF file has a body, but there are no voxels");
  EXPECT_EQ(dir.count(), 0);
}

TEST(Export3mf, CountsTheVerticesThatWaitForTheirFaces) {
  const TempDir dir;
  const ExportedScene scene(5, 2000);
  MemoryBudget memory(1000);
  ExportOptions options;
  options.memory = &memory;
  EXPECT_THROW(export_3mf(dir / "v.3mf", scene.view(), scene.grid, options), OverMemory);
  EXPECT_EQ(dir.count(), 0);
}

}  // namespace
}  // namespace voxdag
